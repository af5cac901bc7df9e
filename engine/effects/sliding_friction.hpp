/// Sliding friction: an elastic spring along the contact, capped by Coulomb's law.
///
///   T = -k s - g u,   |T| <= mu F,   k = 8 G* a
///
///   s  tangential displacement since the contact closed, m (history)    u  slip velocity, m/s
///   a  radius of the contact patch, m    G*  reduced shear modulus, Pa  F  grip force, N
///   g  tangential dashpot, N s/m
///
/// The displacement turns with the contact: it is projected on the new tangent plane at its old
/// length. Where the spring alone passes the cap, the displacement is set back until it meets it;
/// where spring and dashpot together do, the force is.
///
/// The stiffness follows the patch while the displacement stays, so that a contact sheared, pressed
/// further and sheared back gives out (k2 - k1) s^2 / 2 more than it was given (Elata & Berryman
/// 1996, Mech. Mater. 24, 229-240, on such laws); dashpots and the cap take far more in a bed.
///
/// Source: Mindlin 1949, J. Appl. Mech. 16, 259-268 (stiffness without slip); Cundall & Strack
///         1979, Geotechnique 29, 47-65 (incremental spring with cap).
/// Null:   mu = 0: the cap is zero, so the force is exactly zero.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct SlidingFriction {
  struct Parameters {
    double coefficient;
  };
  using Coefficients = Parameters;

  static constexpr EffectText text{
      .name = "sliding_friction",
      .title = "Sliding friction",
      .summary = "Surfaces resist sliding on one another, up to a share of the force between them.",
      .citation = "Mindlin 1949, J. Appl. Mech. 16, 259-268",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::coefficient,
                        {.name = "coefficient",
                         .unit = unit::one,
                         .meaning = "largest tangential force over normal force",
                         .null_value = 0.0,
                         .lower = 0.0,
                         .upper = 2.0}},
  };
  static constexpr Stage stage = Stage::friction;
  static constexpr Scope scope = Scope::pair;

  static constexpr Parameters strong(const GrainScale&) { return {0.6}; }
  static constexpr int history_columns = 3;

  static Coefficients prepare(const Parameters& p, const PairElastic&) { return p; }

  static void contact(ContactBlock& c, const Coefficients& p, HistoryBlock history, double dt) {
    const double shear = 8.0 * c.shear_modulus, mu = p.coefficient;
    double* __restrict const sx = history.column(0);
    double* __restrict const sy = history.column(1);
    double* __restrict const sz = history.column(2);
    for (int i = 0; i < ContactBlock::width; ++i) {
      const double nx = c.normal_x[i], ny = c.normal_y[i], nz = c.normal_z[i];
      const double ux = c.slip_x[i], uy = c.slip_y[i], uz = c.slip_z[i];
      const double out = sx[i] * nx + sy[i] * ny + sz[i] * nz;
      double x = sx[i] - out * nx, y = sy[i] - out * ny, z = sz[i] - out * nz;
      const double before = sx[i] * sx[i] + sy[i] * sy[i] + sz[i] * sz[i];
      const double after = x * x + y * y + z * z;
      const double stretch = after > 0.0 ? std::sqrt(before / after) : 1.0;
      x = x * stretch + ux * dt;
      y = y * stretch + uy * dt;
      z = z * stretch + uz * dt;
      const double k = shear * c.patch_radius[i], g = c.shear_damping[i];
      const double limit = mu * c.grip_force[i];
      const double spring = k * std::sqrt(x * x + y * y + z * z);
      const double held = spring > limit ? limit / spring : 1.0;
      x *= held;
      y *= held;
      z *= held;
      const double tx = -k * x - g * ux, ty = -k * y - g * uy, tz = -k * z - g * uz;
      const double trial = std::sqrt(tx * tx + ty * ty + tz * tz);
      const double keep = trial > limit ? limit / trial : 1.0;
      c.tangent_x[i] = keep * tx;
      c.tangent_y[i] = keep * ty;
      c.tangent_z[i] = keep * tz;
      sx[i] = x;
      sy[i] = y;
      sz[i] = z;
    }
  }
};

}  // namespace repose::engine::effects
