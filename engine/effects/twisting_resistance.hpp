/// Twisting resistance: a couple about the normal that winds up with the turning, up to a cap.
///
///   M <- M - k w dt,   |M| <= mu_t R* F,   k = 4 G* a^3
///
///   M  couple about the normal, N m (history)     w  spin i - spin j about the normal, rad/s
///   a  radius of the contact patch, m     R*  reduced radius, m     F  grip force, N
///
/// The stiffness is that of the tangential spring, 8 G* a, spread over the patch: half of it times
/// a^2.
///
/// Source: Marshall 2009, J. Comput. Phys. 228, 1541-1561 (spring and cap; there the cap is 2/3 a
///         mu F, far smaller for hard round grains).
/// Null:   mu_t = 0: the cap is zero, so the couple is exactly zero.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct TwistingResistance {
  struct Parameters {
    double coefficient;
  };
  using Coefficients = Parameters;

  static constexpr EffectText text{
      .name = "twisting_resistance",
      .title = "Twisting resistance",
      .summary = "Grains resist turning on the spot against one another: angles rise a little.",
      .citation = "Marshall 2009, J. Comput. Phys. 228, 1541-1561",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::coefficient,
                        {.name = "coefficient",
                         .unit = unit::one,
                         .meaning = "largest couple about the normal over (reduced radius x normal "
                                    "force)",
                         .null_value = 0.0,
                         .lower = 0.0,
                         .upper = 0.5}},
  };
  static constexpr Stage stage = Stage::rolling;
  static constexpr Scope scope = Scope::pair;

  static constexpr Parameters strong(const GrainScale&) { return {0.2}; }

  static constexpr int history_columns = 1;

  static Coefficients prepare(const Parameters& p, const PairElastic&) { return p; }

  static void contact(ContactBlock& c, const Coefficients& p, HistoryBlock history, double dt) {
    const double shear = 4.0 * c.shear_modulus * dt, mu = p.coefficient;
    double* __restrict const couple = history.column(0);
    for (int i = 0; i < ContactBlock::width; ++i) {
      const double nx = c.normal_x[i], ny = c.normal_y[i], nz = c.normal_z[i];
      const double w = (c.i.wx[i] - c.j.wx[i]) * nx + (c.i.wy[i] - c.j.wy[i]) * ny +
                       (c.i.wz[i] - c.j.wz[i]) * nz;
      const double a = c.patch_radius[i];
      const double trial = couple[i] - shear * a * a * a * w;
      const double cap = mu * c.radius[i] * c.grip_force[i];
      const double below = trial < cap ? trial : cap;
      const double m = below > -cap ? below : -cap;
      c.couple_x[i] += m * nx;
      c.couple_y[i] += m * ny;
      c.couple_z[i] += m * nz;
      couple[i] = m;
    }
  }
};

}  // namespace repose::engine::effects
