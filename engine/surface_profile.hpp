/// Surface profile: how high a bed stands, place by place along a slope. The height at a place is
/// the mean, over points across the slope, of the top of the uppermost grain above the point: what
/// an upright laser beam would meet. No grain moves it by more than its share of the points, and a
/// place with few grains is not read too low.
#pragma once

#include <vector>

#include "engine/line_fit.hpp"
#include "engine/world.hpp"

namespace repose::engine {

/// Height of the surface at a place.
struct SurfaceHeight {
  double place = 0.0;    ///< distance from the axis, or x, m
  double height = 0.0;   ///< mean over the points with a grain above them, m
  double covered = 0.0;  ///< share of such points, 1
};

using SurfaceProfile = std::vector<SurfaceHeight>;

/// Where a profile is read: the middles of `count` equal parts from one end to the other, at as
/// many points across the slope as said.
struct Places {
  double from = 0.0, to = 0.0;  ///< m
  int count = 1;
  int points = 1;
};

/// Along the radius, at points on circles round the z axis.
SurfaceProfile radial_profile(const World& world, const Places& places);

/// Along x, at points along a periodic y.
SurfaceProfile straight_profile(const World& world, const Places& places);

/// The places that are covered at half of their points or more.
SurfaceProfile covered_places(const SurfaceProfile& profile);

/// Straight line through a profile of two places or more.
LineFit line_through(const SurfaceProfile& profile);

/// Root mean square of the heights' distances from the line, m.
double roughness(const SurfaceProfile& profile, const LineFit& line);

}  // namespace repose::engine
