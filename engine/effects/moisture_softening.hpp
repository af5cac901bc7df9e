/// Moisture softening: wet grains are softer than dry ones.
///
///   G <- G exp(-k (M - M0))
///
///   G  shear modulus of the grains at M0, Pa     k  rate, 1     M  moisture of the experiment, 1
///   M0 moisture at which the model's modulus is meant, 1
///
/// The exponential is the plainest fall that stays above zero. Its rate for wheat, of which Young's
/// modulus fell from 394.8 to 99.2 MPa between 9.3 and 22.5 %, is 10.5; for soybean, from 176.9 to
/// 112.7 MPa between 10 and 13 % (table 2 of Boac et al. 2010, Trans. ASABE 53(4), 1201-1216), 15.
///
/// Source: Shelef & Mohsenin 1969, Cereal Chem. 46, 242-253 (the fall, of maize); Ponce-Garcia et
///         al. 2008, Cereal Chem. 85, 667-672 (the figures of wheat).
/// Null:   k = 0: the modulus is multiplied by exactly one. M0 is data.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct MoistureSoftening {
  struct Parameters {
    double rate;
    double reference;
  };

  static constexpr EffectText text{
      .name = "moisture_softening",
      .title = "Softening by moisture",
      .summary =
          "Wet grains are softer than dry ones: beds of wet grains give way more under load.",
      .citation = "Ponce-Garcia et al. 2008, Cereal Chem. 85, 667-672",
      .condition = "moisture",
  };
  static constexpr std::array fields{
      Field<Parameters>{
          &Parameters::rate,
          {.name = "rate",
           .unit = unit::one,
           .meaning = "fall of the logarithm of the grains' shear modulus with moisture",
           .null_value = 0.0,
           .lower = 0.0,
           .upper = 40.0}},
      Field<Parameters>{&Parameters::reference,
                        {.name = "reference",
                         .unit = unit::percent,
                         .meaning = "moisture at which the model's modulus is meant",
                         .null_value = 0.12,
                         .lower = 0.0,
                         .upper = 0.6}},
  };
  static constexpr Stage stage = Stage::amendment;
  static constexpr Scope scope = Scope::material;

  static constexpr Parameters strong(const GrainScale&) { return {15.0, 0.12}; }

  static constexpr std::string_view amends = "material.shear_modulus";

  static double factor(const Parameters& p, const Conditions& conditions) {
    return std::exp(-p.rate * (conditions.moisture - p.reference));
  }
};

}  // namespace repose::engine::effects
