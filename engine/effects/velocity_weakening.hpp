/// Velocity weakening: surfaces that slide hold less than surfaces at rest.
///
///   F <- F (1 - (1 - q) v / (v + v_c))
///
///   F  grip force, on which friction leans, N     v  slip speed at the contact, m/s
///   q  kinetic over static friction, 1
///   v_c  slip speed at which half of the fall is reached, m/s
///
/// The coefficient of sliding friction is then the static one. It acts by what friction leans on,
/// so that the caps of rolling and twisting, where they lean on the same force, fall with it at
/// contacts that slide.
///
/// Source: Ampuero & Ben-Zion 2008, Geophys. J. Int. 173, 674-692 (weakening as v / (v + v_c)).
/// Null:   q = 1: the grip force is multiplied by exactly one.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct VelocityWeakening {
  struct Parameters {
    double ratio;
    double speed;
  };
  using Coefficients = Parameters;

  static constexpr EffectText text{
      .name = "velocity_weakening",
      .title = "Velocity weakening",
      .summary =
          "Sliding contacts hold less than resting ones: the angle at which a bed starts to "
          "slide exceeds the one at which it stops.",
      .citation = "Ampuero & Ben-Zion 2008, Geophys. J. Int. 173, 674-692",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::ratio,
                        {.name = "ratio",
                         .unit = unit::one,
                         .meaning = "kinetic over static coefficient of friction",
                         .null_value = 1.0,
                         .lower = 0.2,
                         .upper = 1.0}},
      Field<Parameters>{&Parameters::speed,
                        {.name = "speed",
                         .unit = unit::metre_per_second,
                         .meaning = "slip speed at which half of the fall is reached",
                         .null_value = 0.01,
                         .lower = 1e-4,
                         .upper = 1.0}},
  };
  static constexpr Stage stage = Stage::friction;
  static constexpr Scope scope = Scope::pair;

  static constexpr Parameters strong(const GrainScale&) { return {0.5, 0.01}; }

  static constexpr int history_columns = 0;

  static Coefficients prepare(const Parameters& p, const PairElastic&) { return p; }

  static void contact(ContactBlock& c, const Coefficients& p, HistoryBlock, double) {
    const double fall = 1.0 - p.ratio, middle = p.speed;
    for (int i = 0; i < ContactBlock::width; ++i) {
      const double ux = c.slip_x[i], uy = c.slip_y[i], uz = c.slip_z[i];
      const double v = std::sqrt(ux * ux + uy * uy + uz * uz);
      c.grip_force[i] *= 1.0 - fall * (v / (v + middle));
    }
  }
};

}  // namespace repose::engine::effects
