/// Tapping: the vessel is shaken upright while it is filled.
///
///   g <- g + A sin(w t)   downwards
///
///   A  largest acceleration of the apparatus, m/s2     w  angular frequency, rad/s
///   t  since the filling began, s
///
/// The apparatus, its source included, moves as one; the run is seen from it, so that gravity
/// swings instead. Grains leave the floor and pack anew where A exceeds g.
///
/// Source: Knight, Fandrich, Lau, Jaeger & Nagel 1995, Phys. Rev. E 51, 3957-3963 (density by the
///         ratio of A to g, taps of 30 Hz).
/// Null:   A = 0: gravity is left alone. The frequency is data.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct Tapping {
  struct Parameters {
    double acceleration;
    double frequency;
  };
  using Coefficients = Parameters;

  static constexpr EffectText text{
      .name = "tapping",
      .title = "Tapping during filling",
      .summary =
          "A vessel that is shaken while it is filled holds more: the test weight rises, and "
          "nothing else does.",
      .citation = "Knight et al. 1995, Phys. Rev. E 51, 3957-3963",
  };
  static constexpr double thirty_hertz = 2.0 * unit::pi * 30.0;  // rad/s
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::acceleration,
                        {.name = "acceleration",
                         .unit = unit::metre_per_second_squared,
                         .meaning = "largest acceleration of the shaken kettle",
                         .null_value = 0.0,
                         .lower = 0.0,
                         .upper = 60.0}},
      Field<Parameters>{&Parameters::frequency,
                        {.name = "frequency",
                         .unit = unit::revolution_per_minute,
                         .meaning = "of the shaking",
                         .null_value = thirty_hertz,
                         .lower = unit::pi * 10.0,
                         .upper = unit::pi * 400.0}},
  };
  static constexpr Stage stage = Stage::filling;
  static constexpr Scope scope = Scope::global;

  static constexpr Parameters strong(const GrainScale&) { return {20.0, thirty_hertz}; }

  /// Of the apparatus, that long after the filling began, upwards, m/s2.
  static double lift(const Coefficients& p, double time) {
    return p.acceleration * std::sin(p.frequency * time);
  }
};

}  // namespace repose::engine::effects
