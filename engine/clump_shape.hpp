/// ClumpShape: a rigid grain made of spheres that may overlap, seen from its centre of mass along
/// its principal axes.
///
/// Mass and inertia are those of the UNION of the spheres, at uniform density: where members
/// overlap there is no more matter than elsewhere. The sums over whole spheres are exact; what
/// overlaps count too often is integrated over columns and taken off: relative error below 1e-5,
/// none where nothing overlaps.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/quaternion.hpp"
#include "engine/result.hpp"

namespace repose::engine {

/// A sphere of a clump.
struct ClumpMember {
  Vec3 centre;          ///< m
  double radius = 0.0;  ///< m

  bool operator==(const ClumpMember&) const = default;
};

struct ClumpShape {
  std::vector<ClumpMember> members;  ///< centres from the centre of mass, in principal axes
  Quaternion axes;                   ///< turns principal axes into those the shape was given in
  double volume = 0.0;               ///< of the union, m3
  Vec3 inertia;                      ///< principal moments at unit density, m5
  double bounding_radius = 0.0;      ///< of the sphere about the centre of mass that holds all, m

  bool operator==(const ClumpShape&) const = default;
};

inline constexpr std::size_t most_clump_members = 8;

/// The shape of these spheres in any axes, or what is wrong with them.
Result<ClumpShape, std::string> clump_shape(std::span<const ClumpMember> members);

/// Diameter of the sphere of equal volume, m.
double equivalent_diameter(const ClumpShape& shape);

}  // namespace repose::engine
