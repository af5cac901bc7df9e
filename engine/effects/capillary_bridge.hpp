/// Capillary bridge: a drop of liquid between two grains that have touched holds them together.
///
///   F = 2 pi R g cos(t) / (1 + 1.05 x + 2.5 x^2),   x = S sqrt(R / V)
///
///   R  2 R*: the radius of equal grains, twice that of a grain at a wall, m
///   g  surface tension, N/m     t  contact angle, rad
///   S  gap between the surfaces, m (touching: 0)     V  volume of the bridge, m3, given as V / R^3
///
/// A bridge forms when grains touch and breaks at S = (1 + t/2) V^(1/3). Every contact has its
/// bridge: liquid is neither used up nor moved, and its viscosity is left out. Friction keeps
/// leaning on the repulsion, which bears load and bridge alike. The fit holds for V / R^3 below
/// about 0.001 to 0.01.
///
/// Source: Willett, Adams, Johnson & Seville 2000, Langmuir 16, 9396-9405 (fit, Derjaguin's radius
///         for unequal spheres); Lian, Thornton & Adams 1993, J. Colloid Interface Sci. 161,
///         138-147 (where it breaks).
/// Null:   g = 0: there is no force. Volume and angle are data of the liquid.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct CapillaryBridge {
  struct Parameters {
    double tension;
    double volume;
    double angle;
  };
  struct Coefficients {
    double force;      ///< 2 pi g cos(t), N/m
    double sharpness;  ///< x R / S = 1 / sqrt(V / R^3), 1
    double rupture;    ///< S / R where the bridge breaks, 1
  };

  static constexpr EffectText text{
      .name = "capillary_bridge",
      .title = "Capillary bridge",
      .summary =
          "Moist grains hold together across small gaps: even a little liquid steepens heaps "
          "and loosens beds.",
      .citation = "Willett et al. 2000, Langmuir 16, 9396-9405",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::tension,
                        {.name = "tension",
                         .unit = unit::newton_per_metre,
                         .meaning = "surface tension of the liquid; water: 0.073 N/m",
                         .null_value = 0.0,
                         .lower = 0.0,
                         .upper = 0.5}},
      Field<Parameters>{&Parameters::volume,
                        {.name = "volume",
                         .unit = unit::one,
                         .meaning = "volume of a bridge over the cube of twice the reduced radius",
                         .null_value = 1e-3,
                         .lower = 1e-6,
                         .upper = 1e-2}},
      Field<Parameters>{&Parameters::angle,
                        {.name = "angle",
                         .unit = unit::degree,
                         .meaning = "contact angle of the liquid on the grains",
                         .null_value = 0.0,
                         .lower = 0.0,
                         .upper = 50.0 * unit::degree.factor}},
  };
  static constexpr Stage stage = Stage::adhesion;
  static constexpr Scope scope = Scope::pair;

  /// The force at touch is twice a grain's weight, but no liquid pulls harder than water.
  static Parameters strong(const GrainScale& g) {
    const double tension = 2.0 * g.weight() / (2.0 * unit::pi * g.radius);
    return {tension < 0.073 ? tension : 0.073, 1e-3, 0.0};
  }

  static constexpr int history_columns = 1;  ///< 1 while there is a bridge, else 0

  static Coefficients prepare(const Parameters& p, const PairElastic&) {
    return {2.0 * unit::pi * p.tension * std::cos(p.angle),
            1.0 / std::sqrt(p.volume),
            (1.0 + 0.5 * p.angle) * std::cbrt(p.volume)};
  }

  /// Gap at which a bridge breaks, m.
  static double reach(const Coefficients& k, double reduced_radius) {
    return 2.0 * reduced_radius * k.rupture;
  }

  static void contact(ContactBlock& c, const Coefficients& k, HistoryBlock history, double) {
    const double force = k.force, sharpness = k.sharpness, rupture = k.rupture;
    double* __restrict const bridges = history.column(0);
    for (int i = 0; i < ContactBlock::width; ++i) {
      const double r = 2.0 * c.radius[i], gap = c.gap[i];
      const double kept = gap > rupture * r ? 0.0 : bridges[i];
      const double bridge = c.overlap[i] > 0.0 ? 1.0 : kept;
      const double x = sharpness * gap / r;
      c.normal_force[i] -= bridge * force * r / (1.0 + (1.05 + 2.5 * x) * x);
      bridges[i] = bridge;
    }
  }
};

}  // namespace repose::engine::effects
