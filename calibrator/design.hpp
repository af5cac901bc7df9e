/// Space-filling sets of points: the first batch of a calibration, and candidates to look at.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "calibrator/search_space.hpp"

namespace repose::calibrator {

/// A Latin hypercube: on every axis, each of `count` equal slices holds exactly one point, at
/// random within it. `index` tells designs of one seed apart. Source: McKay, Beckman & Conover
/// 1979, Technometrics 21, 239-245.
std::vector<UnitPoint> latin_hypercube(std::size_t count,
                                       std::size_t dimensions,
                                       std::uint64_t seed,
                                       std::uint64_t index = 0);

/// The one of 30 Latin hypercubes whose closest two points are farthest apart.
/// Source: Johnson, Moore & Ylvisaker 1990, J. Stat. Plan. Inference 26, 131-148 (maximin
/// distance).
std::vector<UnitPoint> spread_design(std::size_t count,
                                     std::size_t dimensions,
                                     std::uint64_t seed,
                                     std::uint64_t index = 0);

/// The same among the points that the space's constraints allow: of each hypercube those, from as
/// many hypercubes as it takes. Fewer than `count` where they are too rare to be found.
std::vector<UnitPoint> allowed_points(const SearchSpace& space,
                                      std::size_t count,
                                      std::uint64_t seed,
                                      std::uint64_t index = 0);
std::vector<UnitPoint> spread_design(const SearchSpace& space,
                                     std::size_t count,
                                     std::uint64_t seed,
                                     std::uint64_t index = 0);

/// Distance of the closest two points.
double smallest_distance(const std::vector<UnitPoint>& points);

}  // namespace repose::calibrator
