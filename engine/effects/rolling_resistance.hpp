/// Rolling resistance: a couple of constant size against relative rolling.
///
///   M = -mu_r R* F w / |w|
///
///   w  spin i - spin j without the twist, rad/s     R*  reduced radius, m     F  elastic force, N
///
/// The cap has the reduced radius: half a grain's radius between equal grains, all of it at a wall.
/// Codes whose couple uses the grain's own radius need half the coefficient between grains. The
/// couple keeps its size at the slightest rolling, so a bed at rest trembles below the threshold of
/// rest.
///
/// Source: Zhou, Wright, Yang, Xu & Yu 1999, Physica A 269, 536-553; model A of Ai, Chen, Rotter &
///         Ooi 2011, Powder Technology 206, 269-282.
/// Null:   mu_r = 0: the couple is exactly zero.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct RollingResistance {
  struct Parameters {
    double coefficient;
  };
  using Coefficients = Parameters;

  static constexpr EffectText text{
      .name = "rolling_resistance",
      .title = "Rolling resistance",
      .summary =
          "Grains that are not perfect spheres resist rolling, with a couple of constant size.",
      .citation = "Zhou et al. 1999, Physica A 269, 536-553",
      .family = "rolling",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::coefficient,
                        {.name = "coefficient",
                         .unit = unit::one,
                         .meaning = "couple over (reduced radius x elastic normal force)",
                         .null_value = 0.0,
                         .lower = 0.0,
                         .upper = 1.0}},
  };
  static constexpr Stage stage = Stage::rolling;
  static constexpr Scope scope = Scope::pair;

  static constexpr Parameters strong(const GrainScale&) { return {0.2}; }
  static constexpr int history_columns = 0;

  static Coefficients prepare(const Parameters& p, const PairElastic&) { return p; }

  static void contact(ContactBlock& c, const Coefficients& p, HistoryBlock, double) {
    const double mu = p.coefficient;
    for (int i = 0; i < ContactBlock::width; ++i) {
      const double wx = c.roll_x[i], wy = c.roll_y[i], wz = c.roll_z[i];
      const double w = std::sqrt(wx * wx + wy * wy + wz * wz);
      const double size = w > 0.0 ? mu * c.radius[i] * c.elastic_force[i] / w : 0.0;
      c.couple_x[i] -= size * wx;
      c.couple_y[i] -= size * wy;
      c.couple_z[i] -= size * wz;
    }
  }
};

}  // namespace repose::engine::effects
