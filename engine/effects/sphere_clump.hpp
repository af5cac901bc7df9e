/// Sphere clump: grains are rigid clumps of up to eight spheres, placed by the user.
///
///   x_k, y_k, z_k, radius_k   centre and radius of sphere k; one of radius 0 is not there
///
/// The clump is scaled until its volume, that of the union of its spheres, is that of the sphere of
/// the material's diameter: only the ratios of the lengths count. The spheres must hold together: a
/// chain of touching ones joins any two, and none lies wholly inside another. Grains are put in
/// with orientations that have no preference; a spread of sizes scales whole clumps.
///
/// Source: multi-sphere grains after Favier et al. 1999, Engineering Computations 16, 467-480.
/// Null:   all radii 0: grains are spheres.
#pragma once

#include <array>
#include <vector>

#include "engine/effect.hpp"

namespace repose::engine::effects {

/// A coordinate of a sphere's centre.
template <class P>
constexpr Field<P> clump_centre(double P::*member, std::string_view name) {
  return {member,
          {.name = name,
           .unit = unit::millimetre,
           .meaning = "coordinate of a sphere's centre",
           .null_value = 0.0,
           .lower = -0.05,
           .upper = 0.05}};
}

template <class P>
constexpr Field<P> clump_radius(double P::*member, std::string_view name) {
  return {member,
          {.name = name,
           .unit = unit::millimetre,
           .meaning = "radius of a sphere; 0: it is not there",
           .null_value = 0.0,
           .lower = 0.0,
           .upper = 0.05}};
}

struct SphereClump {
  struct Parameters {
    double x_1, y_1, z_1, radius_1;
    double x_2, y_2, z_2, radius_2;
    double x_3, y_3, z_3, radius_3;
    double x_4, y_4, z_4, radius_4;
    double x_5, y_5, z_5, radius_5;
    double x_6, y_6, z_6, radius_6;
    double x_7, y_7, z_7, radius_7;
    double x_8, y_8, z_8, radius_8;
  };

  static constexpr EffectText text{
      .name = "sphere_clump",
      .title = "Clump of spheres",
      .summary = "Grains are clumps of spheres that the user places, of the mean grain's volume.",
      .citation = "Favier et al. 1999, Engineering Computations 16, 467-480",
      .family = "shape",
  };

  using P = Parameters;
  static constexpr std::array fields{
      clump_centre(&P::x_1, "x_1"), clump_centre(&P::y_1, "y_1"),
      clump_centre(&P::z_1, "z_1"), clump_radius(&P::radius_1, "radius_1"),
      clump_centre(&P::x_2, "x_2"), clump_centre(&P::y_2, "y_2"),
      clump_centre(&P::z_2, "z_2"), clump_radius(&P::radius_2, "radius_2"),
      clump_centre(&P::x_3, "x_3"), clump_centre(&P::y_3, "y_3"),
      clump_centre(&P::z_3, "z_3"), clump_radius(&P::radius_3, "radius_3"),
      clump_centre(&P::x_4, "x_4"), clump_centre(&P::y_4, "y_4"),
      clump_centre(&P::z_4, "z_4"), clump_radius(&P::radius_4, "radius_4"),
      clump_centre(&P::x_5, "x_5"), clump_centre(&P::y_5, "y_5"),
      clump_centre(&P::z_5, "z_5"), clump_radius(&P::radius_5, "radius_5"),
      clump_centre(&P::x_6, "x_6"), clump_centre(&P::y_6, "y_6"),
      clump_centre(&P::z_6, "z_6"), clump_radius(&P::radius_6, "radius_6"),
      clump_centre(&P::x_7, "x_7"), clump_centre(&P::y_7, "y_7"),
      clump_centre(&P::z_7, "z_7"), clump_radius(&P::radius_7, "radius_7"),
      clump_centre(&P::x_8, "x_8"), clump_centre(&P::y_8, "y_8"),
      clump_centre(&P::z_8, "z_8"), clump_radius(&P::radius_8, "radius_8"),
  };
  static constexpr Stage stage = Stage::population;
  static constexpr Scope scope = Scope::material;

  /// The spheres that are there, in the user's axes, before scaling.
  static std::vector<ClumpMember> shape(const Parameters& p) {
    std::vector<ClumpMember> members;
    for (std::size_t k = 0; k < fields.size(); k += 4) {
      const ClumpMember member{
          {p.*fields[k].member, p.*fields[k + 1].member, p.*fields[k + 2].member},
          p.*fields[k + 3].member};
      if (member.radius > 0.0) members.push_back(member);
    }
    return members;
  }
};

static_assert(SphereClump::fields.size() == 4 * most_clump_members);

}  // namespace repose::engine::effects
