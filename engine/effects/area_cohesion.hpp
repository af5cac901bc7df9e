/// Area cohesion: grains in contact attract one another in proportion to the area they share.
///
///   F = k A,   A = pi d (2 R_i - d) (2 R_j - d) (2 (R_i + R_j) - d) / (4 r^2),
///   r = R_i + R_j - d;   at a wall A = pi d (2 R_i - d)
///
///   k  cohesion energy density, J/m3     d  overlap, m     R_i, R_j  radii, m
///   A  area of the circle in which the two spheres (or sphere and plane) cut each other, m2
///
/// The circle is the area of LIGGGHTS's `sjkr`; for small overlaps it is 2 pi R* d, twice that of
/// Hertz's contact patch. Its `sjkr2` has 4 pi R* d: between grains k is half as large there, at
/// walls the same. The attraction ends where the overlap does.
/// Friction keeps leaning on the repulsion alone: two grains pressed with P and held by F meet with
/// P + F, so Coulomb's cap is mu (P + F) already, and to add F once more would count it twice.
///
/// Source: LIGGGHTS(R)-PUBLIC documentation, cohesion model `sjkr` (the area; the friction cap
///         without the attraction); Derjaguin 1934, Z. Phys. 88, 661-675 (friction leans on load
///         plus attraction).
/// Null:   k = 0: nothing is taken from the force.
#pragma once

#include <array>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct AreaCohesion {
  struct Parameters {
    double energy_density;
  };
  using Coefficients = Parameters;

  static constexpr EffectText text{
      .name = "area_cohesion",
      .title = "Area cohesion",
      .summary =
          "Touching grains attract one another: heaps stand steeper, beds pack looser and "
          "flow slower.",
      .citation = "LIGGGHTS(R)-PUBLIC documentation, cohesion model sjkr",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::energy_density,
                        {.name = "energy_density",
                         .unit = unit::joule_per_cubic_metre,
                         .meaning = "attraction over the area of the circle in which two spheres "
                                    "cut each other",
                         .null_value = 0.0,
                         .lower = 0.0,
                         .upper = 2e5}},
  };
  static constexpr Stage stage = Stage::adhesion;
  static constexpr Scope scope = Scope::pair;

  /// A contact that bears a grain's weight attracts with as much.
  static Parameters strong(const GrainScale& g) {
    return {g.weight() / (unit::pi * g.radius * g.overlap())};
  }

  static constexpr int history_columns = 0;

  static Coefficients prepare(const Parameters& p, const PairElastic&) { return p; }

  static void contact(ContactBlock& c, const Coefficients& p, HistoryBlock, double) {
    const double circle = unit::pi * p.energy_density;
    for (int i = 0; i < ContactBlock::width; ++i) {
      const double d = c.overlap[i], ri = c.i.radius[i], rj = c.j.radius[i];
      const double r = ri + rj - d;
      const double share = (2.0 * rj - d) * (2.0 * (ri + rj) - d) / (4.0 * r * r);
      const double flatness = rj > 0.0 ? share : 1.0;
      c.normal_force[i] -= circle * d * (2.0 * ri - d) * flatness;
    }
  }
};

}  // namespace repose::engine::effects
