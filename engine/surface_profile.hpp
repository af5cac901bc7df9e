/// Surface profile: how high a bed stands, place by place along a slope.
#pragma once

#include <functional>
#include <vector>

#include "engine/line_fit.hpp"
#include "engine/world.hpp"

namespace repose::engine {

/// Height of the surface at a place.
struct SurfaceHeight {
  double place = 0.0;    ///< distance from the axis, or x, m
  double height = 0.0;   ///< mean over the points or sectors with a grain, m
  double covered = 0.0;  ///< share of the points or sectors with a grain, 1
};

using SurfaceProfile = std::vector<SurfaceHeight>;

/// Where a profile is read: the middles of `count` equal parts from one end to the other, at as
/// many points or in as many sectors across the slope as said.
struct Places {
  double from = 0.0, to = 0.0;  ///< m
  int count = 1;
  int points = 1;
};

/// Along the radius: in each of `count` rings round the z axis the mean, over `points` sectors, of
/// the highest top of the grains whose centres are in it.
SurfaceProfile ring_profile(const World& world, const Places& places);

/// Along x: the mean, over points along a periodic y, of the top of the uppermost grain above the
/// point: what an upright laser beam would meet. No grain moves it by more than its share of the
/// points, and a place with few grains is not read too low. Of the grains of the bed alone, where
/// there are others.
SurfaceProfile straight_profile(const World& world,
                                const Places& places,
                                const std::function<bool(const GrainRow&)>& of_bed = {});

/// The places that are covered at half of their points or more.
SurfaceProfile covered_places(const SurfaceProfile& profile);

/// Straight line through a profile of two places or more.
LineFit line_through(const SurfaceProfile& profile);

/// Root mean square of the heights' distances from the line, m.
double roughness(const SurfaceProfile& profile, const LineFit& line);

}  // namespace repose::engine
