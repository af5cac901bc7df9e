/// Material: what a grain or a wall is made of.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "engine/field.hpp"

namespace repose::engine {

/// The two kinds of stuff in an experiment. A wall may be covered with grains' friction: then its
/// contacts are those of (grain, grain).
enum class MaterialId : std::uint8_t { grain, wall };

inline constexpr std::array<std::string_view, 2> material_names{"grain", "wall"};

struct Material {
  double density;        ///< kg/m3
  double diameter;       ///< m, mean by volume; of no meaning for a wall
  double shear_modulus;  ///< Pa
  double poisson_ratio;  ///< 1

  /// Material properties have no null: they must be given where they are needed.
  static constexpr std::string_view name = "material";
};

inline constexpr std::array material_fields{
    Field<Material>{&Material::density,
                    {.name = "density",
                     .unit = unit::kilogram_per_cubic_metre,
                     .meaning = "mass of a grain over its volume, pores inside the grain included",
                     .lower = 10.0,
                     .upper = 25000.0}},
    Field<Material>{&Material::diameter,
                    {.name = "diameter",
                     .unit = unit::millimetre,
                     .meaning = "diameter of the sphere of mean grain volume",
                     .lower = 1e-4,
                     .upper = 0.1}},
    Field<Material>{&Material::shear_modulus,
                    {.name = "shear_modulus",
                     .unit = unit::megapascal,
                     .meaning = "shear modulus G of the solid; E = 2 G (1 + Poisson's ratio)",
                     .lower = 1e4,
                     .upper = 1e12}},
    Field<Material>{&Material::poisson_ratio,
                    {.name = "poisson_ratio",
                     .unit = unit::one,
                     .meaning = "Poisson's ratio of the solid",
                     .lower = 0.0,
                     .upper = 0.499}},
};

}  // namespace repose::engine
