/// Moisture friction: wet grains slide less easily than dry ones.
///
///   mu <- mu max(0, 1 + b (M - M0))
///
///   mu coefficient of sliding friction at M0, 1     b  relative rise, 1
///   M  moisture of the experiment, 1     M0 moisture at which the model's friction is meant, 1
///
/// Rises are linear over the range in which grain is handled. Of soybean between 8 and 16 %, b is
/// 6.8 on galvanised steel (0.164 to 0.286) and 2.2 among grains (internal friction 27.4 to 31.8
/// degrees).
///
/// Source: Kibar & Ozturk 2008, Int. Agrophys. 22, 239-244.
/// Null:   b = 0: the coefficient is multiplied by exactly one. M0 is data.
#pragma once

#include <algorithm>
#include <array>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct MoistureFriction {
  struct Parameters {
    double rise;
    double reference;
  };

  static constexpr EffectText text{
      .name = "moisture_friction",
      .title = "Friction raised by moisture",
      .summary = "Wet grains slide less easily than dry ones: they heap steeper and pack looser.",
      .citation = "Kibar & Ozturk 2008, Int. Agrophys. 22, 239-244",
      .condition = "moisture",
  };
  static constexpr std::array fields{
      Field<Parameters>{
          &Parameters::rise,
          {.name = "rise",
           .unit = unit::one,
           .meaning = "relative rise of the coefficient of sliding friction with moisture",
           .null_value = 0.0,
           .lower = 0.0,
           .upper = 15.0}},
      Field<Parameters>{&Parameters::reference,
                        {.name = "reference",
                         .unit = unit::percent,
                         .meaning = "moisture at which the model's friction is meant",
                         .null_value = 0.12,
                         .lower = 0.0,
                         .upper = 0.6}},
  };
  static constexpr Stage stage = Stage::amendment;
  static constexpr Scope scope = Scope::pair;

  static constexpr Parameters strong(const GrainScale&) { return {6.0, 0.12}; }

  static constexpr std::string_view amends = "sliding_friction.coefficient";

  static double factor(const Parameters& p, const Conditions& conditions) {
    return std::max(0.0, 1.0 + p.rise * (conditions.moisture - p.reference));
  }
};

}  // namespace repose::engine::effects
