/// ContactBlock: 32 contacts side by side, a column per quantity; what effects read and write.
///
/// Conventions. A contact has two ends, i and j; at a wall, j is the wall. The normal points from j
/// to i. Forces and torques are those on i; j receives the opposite force, and its own torque.
///
///   stage         reads                              writes
///   kinematics    ends                               geometry and relative motion
///   Hertz         overlap, radius                    patch_radius, elastic_force, normal_force,
///                                                    grip_force
///   dissipation   patch_radius, mass, approach       normal_force, grip_force, shear_damping
///   adhesion      overlap, gap                       normal_force, grip_force
///   friction      slip, patch_radius, grip_force,    tangent_x..z
///                 shear_damping
///   rolling       roll, spins, elastic_force,        couple_x..z
///                 grip_force
///   loads         all forces                         force, torque_i, torque_j
///   own torques   spins, arms, grip_force            torque_i, torque_j (hook `load`)
///
/// Lanes past the last contact hold two spheres that just touch, at rest: loops always run to
/// `width`.
#pragma once

#include <array>

namespace repose::engine {

/// What the contacts of a block have at their end j.
enum class Partner { grain, wall };

/// Lengths after which a scene repeats along x and y, m; 0 where it does not.
struct Period {
  double x = 0.0, y = 0.0;
};

/// Thirty-two contacts: few enough for the columns to stay in a processor's first cache.
struct ContactBlock {
  static constexpr int width = 32;
  using Column = std::array<double, width>;

  /// The grain (or wall point) at one end of each contact: columns of what its row has, in its
  /// order.
  struct End {
    alignas(64) Column x, y, z;          ///< centre, m
    alignas(64) Column radius;           ///< m; 0 for a wall
    alignas(64) Column vx, vy, vz;       ///< m/s
    alignas(64) Column inverse_mass;     ///< 1/kg; 0 for a wall
    alignas(64) Column wx, wy, wz;       ///< spin, rad/s
    alignas(64) Column inverse_inertia;  ///< 1/(kg m2)
  };
  struct Vector {
    alignas(64) Column x, y, z;
  };

  End i, j;
  Vector force;               ///< what end i receives; end j receives the opposite, N
  Vector torque_i, torque_j;  ///< about the centres, N m
  Period period;              ///< differences of x and y are those of the nearest images

  // Kinematics.
  alignas(64) Column normal_x, normal_y, normal_z;  ///< from j to i, of unit length
  alignas(64) Column slip_x, slip_y, slip_z;        ///< tangential velocity at the contact, m/s
  alignas(64) Column overlap;                       ///< m, >= 0
  alignas(64) Column radius;                        ///< reduced radius R*, m
  alignas(64) Column mass;                          ///< reduced mass m*, kg
  alignas(64) Column arm_i, arm_j;                  ///< from the centres to the contact point, m
  alignas(64) Column approach;                      ///< normal speed of approach, m/s
  alignas(64) Column roll_x, roll_y, roll_z;        ///< spin i - spin j without the twist, rad/s

  // Forces.
  alignas(64) Column patch_radius;   ///< of the contact patch, sqrt(R* overlap), m
  alignas(64) Column elastic_force;  ///< Hertz's, N
  alignas(64) Column normal_force;   ///< on i along the normal, N
  alignas(64) Column grip_force;     ///< what friction may lean on, N, >= 0
  alignas(64) Column shear_damping;  ///< tangential dashpot, N s/m
  alignas(64) Column tangent_x, tangent_y, tangent_z;  ///< friction force on i, N
  alignas(64) Column couple_x, couple_y, couple_z;     ///< rolling couple on i (opposite on j), N m

  /// Between surfaces, m, >= 0; only under laws that reach out.
  alignas(64) Column gap;

  int count = 0;               ///< contacts in the block
  double modulus = 0.0;        ///< E* of the pair, Pa
  double shear_modulus = 0.0;  ///< G* of the pair, Pa
};

/// Most columns of history that the contacts of one model may carry.
inline constexpr int most_history_columns = 12;

/// The history of a block's contacts: columns that belong to the effects that asked for them. A
/// contact's history starts at zero when it closes and is forgotten when it opens.
class HistoryBlock {
 public:
  explicit HistoryBlock(double* first) : first_(first) {}
  [[nodiscard]] double* column(int index) const { return first_ + index * ContactBlock::width; }
  [[nodiscard]] HistoryBlock from(int index) const { return HistoryBlock(column(index)); }

 private:
  double* first_;
};

}  // namespace repose::engine
