/// Clumps: the rigid multi-sphere grains of a world, a body each, and how bodies move.
///
/// A contact sees one sphere. The members of a clump are rows like any others, with consecutive
/// ids; their rows have the body's motion at the member's centre and the inverse mass of the whole
/// grain. Each step the body sums what its members received, moves, and writes their rows anew:
///
///   V += F / m dt + g dt,  X += V dt,  L += (sum r_k x F_k + T_k) dt,
///   orientation by free rotation with L constant
///
/// The angular momentum L is kept in space, where no torque means no change, to the last bit. The
/// free rotation is the symmetric product of turns about the principal axes 1 2 3 2 1 with l_k /
/// I_k (Touma & Wisdom 1994, Astron. J. 107, 1189-1202; Dullweber, Leimkuhler & McLachlan 1997, J.
/// Chem. Phys. 107, 5840-5851): symplectic and reversible, so the energy does not drift; its error
/// swings with (angle per step)^2.
///
/// Two members of a clump may touch the same partner. Both contacts act then, each with the mass of
/// the whole grain, so a face-on impact is stiffer than an end-on one.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "engine/clump_shape.hpp"
#include "engine/grains.hpp"

namespace repose::engine {

/// A clump to put in. It is `scale` times as large as its shape.
struct ClumpPlacement {
  double density = 0.0;  ///< kg/m3
  double scale = 1.0;
  Vec3 centre{};             ///< of mass, m
  Quaternion orientation{};  ///< turns the axes that the shape was given in into those of space
  Vec3 velocity{};           ///< of the centre of mass, m/s
  Vec3 spin{};               ///< rad/s
};

struct ClumpBody {
  std::uint32_t shape = 0;
  std::uint32_t first_id = 0;    ///< of its members
  std::uint32_t first_slot = 0;  ///< of its members among those of all clumps
  double scale = 1.0;
  double mass = 0.0;       ///< kg
  Vec3 inverse_inertia;    ///< principal, 1/(kg m2)
  Vec3 centre;             ///< of mass, m
  Vec3 velocity;           ///< m/s
  Quaternion orientation;  ///< turns principal axes into those of space
  Vec3 angular_momentum;   ///< about the centre, in space, kg m2/s
  Vec3 force;              ///< of this step, gravity apart, N
  Vec3 torque;             ///< about the centre, N m
};

/// Spin of a body in space, rad/s.
Vec3 spin(const ClumpBody& body);
/// Translation and rotation, J.
double kinetic_energy(const ClumpBody& body);

class Clumps {
 public:
  [[nodiscard]] bool empty() const { return bodies_.empty(); }
  [[nodiscard]] const std::vector<ClumpBody>& bodies() const { return bodies_; }
  [[nodiscard]] const ClumpShape& shape(const ClumpBody& body) const { return shapes_[body.shape]; }
  /// The body to which a row's id belongs, or no_body.
  [[nodiscard]] std::uint32_t body_of(std::uint32_t id) const {
    return id < body_of_.size() ? body_of_[id] : no_body;
  }
  /// By id; ids past its end belong to no clump.
  [[nodiscard]] std::span<const std::uint32_t> bodies_of_ids() const { return body_of_; }
  [[nodiscard]] std::size_t members() const { return rows_.size(); }
  /// Rows of all members, body after body.
  [[nodiscard]] std::span<const std::uint32_t> rows() const { return rows_; }

  /// Admits a body whose members will have ids from first_id on; returns their rows.
  std::vector<GrainRow> add(const ClumpShape& shape,
                            const ClumpPlacement& placement,
                            std::uint32_t first_id);
  /// Takes out the bodies marked.
  void remove(const std::vector<std::uint8_t>& leaving);
  /// Finds the members' rows again, after these were re-ordered and folded into the period.
  void locate(const Grains& grains, const Vec3& period);

  /// Sums what the members of each body received in this step.
  void collect(const Grains& grains);
  /// Adds to each body a force at its centre, of the diameter (m) of the sphere of its volume and
  /// its velocity.
  void push(const std::function<Vec3(double diameter, const Vec3& velocity)>& force);
  /// Moves the bodies by a step and writes the rows of their members. Where the scene is periodic a
  /// member keeps to the image in which its row was.
  void advance(double dt, const Vec3& gravity, const Vec3& period, std::vector<GrainRow>& rows);

  /// The body as one sphere about its centre that holds all its members, with its mass and motion.
  [[nodiscard]] GrainRow envelope(const ClumpBody& body) const;

 private:
  std::uint32_t index_of(const ClumpShape& shape);

  std::vector<ClumpShape> shapes_;
  std::vector<ClumpBody> bodies_;
  std::vector<std::uint32_t> body_of_;  ///< by id
  std::vector<std::uint32_t> rows_;     ///< of the members, by slot
  std::vector<Vec3> arms_;              ///< from the body's centre to the member's, by slot, m
};

}  // namespace repose::engine
