/// Restitution: a dashpot beside the Hertz spring, so that a collision gives back e of its speed,
/// whatever that speed.
///
///   F = max(0, K d^(3/2) + c sqrt(m K) d^(1/4) v),   K = (4/3) E* sqrt(R*)
///
///   d  overlap, m      v  speed of approach, m/s      m  reduced mass, kg
///   c  number found by integrating this very law, the cut at zero included, until the rebound is e
///
/// The tangential dashpot is the normal one times sqrt(4 G* / E*), the root of the ratio of
/// tangential to normal stiffness.
///
/// Source: Tsuji, Tanaka & Ishida 1992, Powder Technology 71, 239-250 (form of the dashpot);
///         Schwager & Poeschel 2007, Granular Matter 9, 465-469 (contacts end when the force does,
///         not the overlap).
/// Null:   e = 1: c = 0, the dashpot is exactly zero.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

/// c of a collision that rebounds with e times its speed.
double damping_number(double restitution);

struct Restitution {
  struct Parameters {
    double coefficient;
  };
  struct Coefficients {
    double normal;   ///< c sqrt(4/3 E*), sqrt(Pa)
    double tangent;  ///< tangential over normal dashpot, 1
  };

  static constexpr EffectText text{
      .name = "restitution",
      .title = "Restitution",
      .summary = "Collisions lose energy: grains rebound with a fixed share of their speed.",
      .citation = "Tsuji et al. 1992, Powder Technology 71, 239-250",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::coefficient,
                        {.name = "coefficient",
                         .unit = unit::one,
                         .meaning = "normal speed after a collision over the speed before",
                         .null_value = 1.0,
                         .lower = 0.05,
                         .upper = 1.0}},
  };
  static constexpr Stage stage = Stage::dissipation;
  static constexpr Scope scope = Scope::pair;
  static constexpr int history_columns = 0;

  static Coefficients prepare(const Parameters& p, const PairElastic& pair) {
    return {damping_number(p.coefficient) * std::sqrt(4.0 / 3.0 * pair.modulus),
            std::sqrt(4.0 * pair.shear_modulus / pair.modulus)};
  }

  static void contact(ContactBlock& c, const Coefficients& k, HistoryBlock, double) {
    const double normal = k.normal, tangent = k.tangent;
    for (int i = 0; i < ContactBlock::width; ++i) {
      const double damping = normal * std::sqrt(c.mass[i] * c.patch_radius[i]);
      const double force = c.elastic_force[i] + damping * c.approach[i];
      c.normal_force[i] = force > 0.0 ? force : 0.0;
      c.grip_force[i] = c.normal_force[i];
      c.shear_damping[i] = damping * tangent;
    }
  }
};

}  // namespace repose::engine::effects
