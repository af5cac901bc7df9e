/// Elastic rolling resistance: a couple that grows with the rolling turned, up to a cap.
///
///   M <- M - k_r w dt,   |M| <= mu_r R* F,   k_r = 8 G* a R*^2
///
///   M  couple carried by the contact, N m (history)    w  spin i - spin j without the twist, rad/s
///   a  radius of the contact patch, m    R*  reduced radius, m    F  grip force, N
///
/// The cap has the reduced radius, half of its own radius between equal grains and all of it at a
/// wall: mu_r of a cap on the own radius is half as large between equal grains. Unlike the couple
/// of constant size it holds a bed wholly at rest.
///
/// Source: model C of Ai, Chen, Rotter & Ooi 2011, Powder Technology 206, 269-282, without its
///         dashpot; stiffness after Iwashita & Oda 1998, J. Eng. Mech. 124, 285-292
///         (k_r = k_t R*^2).
/// Null:   mu_r = 0: the cap is zero, so the couple is exactly zero.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct ElasticRollingResistance {
  struct Parameters {
    double coefficient;
  };
  using Coefficients = Parameters;

  static constexpr EffectText text{
      .name = "elastic_rolling_resistance",
      .title = "Elastic rolling resistance",
      .summary = "Grains resist rolling with a couple that winds up like a spring, up to a cap.",
      .citation = "Ai et al. 2011, Powder Technology 206, 269-282",
      .family = "rolling",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::coefficient,
                        {.name = "coefficient",
                         .unit = unit::one,
                         .meaning = "largest couple over (reduced radius x normal force)",
                         .null_value = 0.0,
                         .lower = 0.0,
                         .upper = 1.0}},
  };
  static constexpr Stage stage = Stage::rolling;
  static constexpr Scope scope = Scope::pair;
  static constexpr int history_columns = 3;

  static Coefficients prepare(const Parameters& p, const PairElastic&) { return p; }

  static void contact(ContactBlock& c, const Coefficients& p, HistoryBlock history, double dt) {
    const double shear = 8.0 * c.shear_modulus, mu = p.coefficient;
    double* __restrict const mx = history.column(0);
    double* __restrict const my = history.column(1);
    double* __restrict const mz = history.column(2);
    for (int i = 0; i < ContactBlock::width; ++i) {
      const double nx = c.normal_x[i], ny = c.normal_y[i], nz = c.normal_z[i];
      const double twist = mx[i] * nx + my[i] * ny + mz[i] * nz;
      const double r = c.radius[i];
      const double turn = shear * c.patch_radius[i] * r * r * dt;
      const double x = mx[i] - twist * nx - turn * c.roll_x[i];
      const double y = my[i] - twist * ny - turn * c.roll_y[i];
      const double z = mz[i] - twist * nz - turn * c.roll_z[i];
      const double trial = std::sqrt(x * x + y * y + z * z);
      const double limit = mu * r * c.grip_force[i];
      const double keep = trial > limit ? limit / trial : 1.0;
      mx[i] = x * keep;
      my[i] = y * keep;
      mz[i] = z * keep;
      c.couple_x[i] += mx[i];
      c.couple_y[i] += my[i];
      c.couple_z[i] += mz[i];
    }
  }
};

}  // namespace repose::engine::effects
