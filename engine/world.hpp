/// World: grains, walls and gravity, advanced step by step. Equal input gives equal bits, whoever
/// shares the work.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "engine/boundary.hpp"
#include "engine/clumps.hpp"
#include "engine/contact_list.hpp"
#include "engine/contact_model.hpp"
#include "engine/grains.hpp"
#include "engine/pair_pass.hpp"
#include "engine/wall_motion.hpp"

namespace repose::engine {

/// Rayleigh time of a sphere: how long a shear wave takes over its surface (Sheng, Lawrence,
/// Briscoe & Thornton 2004, Eng. Comput. 21, 304-317): pi R sqrt(rho / G) / (0.1631 nu + 0.8766),
/// s.
double rayleigh_time(double radius, const Material& material);

/// How long two elastic spheres touch that meet at that speed (Johnson 1985, section 11.4):
/// 2.868 (m*^2 / (R* E*^2 v))^(1/5), s.
double impact_time(double mass, double radius, double modulus, double speed);

struct WorldOptions {
  double time_step = 0.0;  ///< s
  Vec3 period;             ///< m; 0 where not periodic; z is never
  Vec3 gravity{0.0, 0.0, -9.81};
  Team team = {};  ///< to share the work of a large run; the bits are the same without
};

class World {
 public:
  World(ContactModel model, const WorldOptions& options);

  /// Puts a grain in; its id is the number of grains put in before it.
  std::uint32_t add(const GrainRow& grain);
  /// Puts a clump in; its members' ids are consecutive, the first is returned.
  std::uint32_t add_clump(const ClumpShape& shape, const ClumpPlacement& placement);
  /// Takes out every grain that the condition names; returns how many. A clump is judged as one
  /// sphere about its centre of mass that holds all its members, and leaves as a whole.
  std::size_t remove(const std::function<bool(const GrainRow&)>& condition);

  /// Walls may be changed between steps through this.
  std::vector<Surface>& change_surfaces();
  [[nodiscard]] const std::vector<Surface>& surfaces() const { return surfaces_; }
  /// Gives a wall another motion, which a servo may do at every step: the neighbour list stays.
  void drive(std::size_t surface, const Vec3& velocity, const Vec3& spin = {});
  /// What the grains did to each surface in the last step.
  [[nodiscard]] std::span<const WallLoad> wall_loads() const { return wall_loads_; }
  /// From now on gravity turns about y, from -z towards +x: a box tilting the other way, rad/s.
  void turn_gravity(double rate);
  /// From now on, until it is stopped, the apparatus is shaken where the model says so: seen from
  /// it, gravity swings.
  void start_shaking();
  void stop_shaking();
  [[nodiscard]] const Vec3& gravity() const { return gravity_; }

  void step();

  /// The spheres, members of clumps among them.
  [[nodiscard]] const Grains& grains() const { return grains_; }
  [[nodiscard]] const Clumps& clumps() const { return clumps_; }
  /// Grains, a clump as one.
  [[nodiscard]] std::size_t grain_count() const {
    return grains_.size() - clumps_.members() + clumps_.bodies().size();
  }
  /// Calls `see` with each grain and its id: spheres in the order of the rows, then clumps, each as
  /// one sphere about its centre of mass that holds all its members, with the id of the first.
  void for_each_grain(const std::function<void(const GrainRow&, std::uint32_t)>& see) const;
  /// Mutable access for tests and experiments that set a grain's motion; a clump's is not in its
  /// members' rows.
  GrainRow& row(std::size_t index) {
    stale_ = true;
    return grains_.rows[index];
  }
  [[nodiscard]] const ContactModel& model() const { return model_; }
  [[nodiscard]] const Vec3& period() const { return options_.period; }
  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] double time_step() const { return options_.time_step; }
  [[nodiscard]] std::uint64_t steps() const { return steps_; }
  [[nodiscard]] std::uint64_t grain_steps() const { return grain_steps_; }
  [[nodiscard]] std::uint64_t rebuilds() const { return rebuilds_; }
  /// Spheres put in so far, members of clumps among them: the next id.
  [[nodiscard]] std::uint64_t inserted() const { return inserted_; }
  /// Grains put in so far, a clump as one.
  [[nodiscard]] std::uint64_t inserted_grains() const { return inserted_grains_; }
  /// Contacts closed in the last step, walls included.
  [[nodiscard]] std::size_t contacts() const { return closed_; }
  [[nodiscard]] const Candidates& pairs() const { return list_.pairs; }

  /// Kinetic energy, rotation included, J. Not a number once the run has gone wrong.
  [[nodiscard]] double kinetic_energy() const;
  /// The same without the spin of spheres, which nothing may stop where they stand on one point, J.
  [[nodiscard]] double visible_energy() const;
  /// Largest overlap over radius among the contacts of the last step.
  [[nodiscard]] double largest_overlap() const;
  /// Bytes held for each grain, contacts and their history included.
  [[nodiscard]] double bytes_per_grain() const;

 private:
  /// What one of the team needs for itself.
  struct Desk {
    std::unique_ptr<ContactBlock> block = std::make_unique<ContactBlock>();
    std::size_t closed = 0;
    bool outlived = false;
  };

  std::uint32_t add_row(const GrainRow& row);
  void rebuild();
  void push_pairs();
  void push_pairs(std::size_t first, std::size_t last, Desk& desk);
  void push_walls();
  void push_spheres();
  void move();
  void move_walls();

  ContactModel model_;
  WorldOptions options_;
  Vec3 gravity_;
  double reach_ = 0.0;  ///< from touch, of the grains there are, m
  double turn_rate_ = 0.0;
  double turn_start_ = 0.0;
  bool shaken_ = false;
  double shaken_since_ = 0.0;
  Grains grains_;
  Clumps clumps_;
  std::vector<Surface> surfaces_;
  std::vector<WallLoad> wall_loads_;
  std::vector<double> travelled_;  ///< by each wall since the list was made, m
  bool walls_move_ = false;
  ContactList list_;
  std::vector<Desk> desks_;  ///< one for each part
  bool stale_ = true;        ///< the list must be made anew
  bool outlived_ = false;    ///< some grain has moved by its skin
  double time_ = 0.0;
  std::uint64_t steps_ = 0;
  std::uint64_t grain_steps_ = 0;
  std::uint64_t rebuilds_ = 0;
  std::uint64_t inserted_ = 0;
  std::uint64_t inserted_grains_ = 0;
  std::size_t closed_ = 0;
};

}  // namespace repose::engine
