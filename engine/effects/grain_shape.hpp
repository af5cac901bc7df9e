/// Grain shape: grains are rigid clumps of overlapping spheres instead of single spheres.
///
///   members   shape (volume that of the sphere of the mean diameter)
///   1         sphere
///   2         two spheres R = 0.877 R1, centres 0.582 R1 apart
///   3         three, R = 0.847 R1, in a flat triangle
///   4         four, R = 0.847 R1, in a cross
///
/// R1 is the radius of the sphere of equal volume. Numbers between are rounded, halves up. Grains
/// are put in with orientations that have no preference; the spread of sizes scales whole shapes.
///
/// Source: Boac et al. 2010, Trans. ASABE 53(4), 1201-1216, Table 7.
/// Null:   1 member: spheres.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "engine/effect.hpp"
#include "engine/soybean_shapes.hpp"

namespace repose::engine::effects {

struct GrainShape {
  struct Parameters {
    double members;
  };

  static constexpr EffectText text{
      .name = "grain_shape",
      .title = "Grain shape",
      .summary = "Grains are soybeans made of one to four overlapping spheres each.",
      .citation = "Boac et al. 2010, Trans. ASABE 53(4), 1201-1216",
      .family = "shape",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::members,
                        {.name = "members",
                         .unit = unit::one,
                         .meaning = "spheres that make a grain, rounded to a whole number",
                         .null_value = 1.0,
                         .lower = 1.0,
                         .upper = static_cast<double>(most_soybean_spheres),
                         .whole = true}},
  };
  static constexpr Stage stage = Stage::population;
  static constexpr Scope scope = Scope::material;

  static constexpr Parameters strong(const GrainScale&) {
    return {static_cast<double>(most_soybean_spheres)};
  }

  /// The spheres of a grain, of any size; a single one means that grains are spheres.
  static std::vector<ClumpMember> shape(const Parameters& p) {
    const auto published = soybean_shapes[static_cast<std::size_t>(std::lround(p.members)) - 1];
    return {published.begin(), published.end()};
  }
};

}  // namespace repose::engine::effects
