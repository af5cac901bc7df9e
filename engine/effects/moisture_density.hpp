/// Moisture density: kernels that take up water swell, and most become lighter for their size.
///
///   rho <- rho exp(-k (M - M0))
///
///   rho density of the grains at M0, kg/m3     k  rate, 1     M  moisture of the experiment, 1
///   M0  moisture at which the model's density is meant, 1
///
/// The form is that of moisture_softening: positive whatever the moisture. Densities of kernels are
/// measured, so k usually is known. Of soybean it is 1.7 (1250 to 1111 kg/m3 between 6.86 and 13.64 %
/// of the wet mass), of wheat 0.5 (1250 to 1190 kg/m3 between 8 and 18 %: Karimi et al. 2009, Pak. J.
/// Nutr. 8, 90-95). Kernels that shrink when they dry may have it below zero.
///
/// Source: Wandkar, Ukey & Pawar 2012, Agric. Eng. Int.: CIGR J. 14(2), 138-142.
/// Null:   k = 0: the density is multiplied by exactly one. M0 is data.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct MoistureDensity {
  struct Parameters {
    double rate;
    double reference;
  };

  static constexpr EffectText text{
      .name = "moisture_density",
      .title = "Kernel density lowered by moisture",
      .summary = "Wet kernels are lighter for their size: a kettle of them weighs less.",
      .citation = "Wandkar et al. 2012, Agric. Eng. Int.: CIGR J. 14(2), 138-142",
      .condition = "moisture",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::rate,
                        {.name = "rate",
                         .unit = unit::one,
                         .meaning = "fall of the logarithm of the kernels' density with moisture",
                         .null_value = 0.0,
                         .lower = -4.0,
                         .upper = 4.0}},
      Field<Parameters>{&Parameters::reference,
                        {.name = "reference",
                         .unit = unit::percent,
                         .meaning = "moisture at which the model's density is meant",
                         .null_value = 0.12,
                         .lower = 0.0,
                         .upper = 0.6}},
  };
  static constexpr Stage stage = Stage::amendment;
  static constexpr Scope scope = Scope::material;

  static constexpr Parameters strong(const GrainScale&) { return {2.0, 0.12}; }

  static constexpr std::string_view amends = "material.density";

  static double factor(const Parameters& p, const Conditions& conditions) {
    return std::exp(-p.rate * (conditions.moisture - p.reference));
  }
};

}  // namespace repose::engine::effects
