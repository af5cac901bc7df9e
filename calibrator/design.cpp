#include "calibrator/design.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "engine/random.hpp"

namespace repose::calibrator {

using engine::Purpose;
using engine::Random;

std::vector<UnitPoint> latin_hypercube(std::size_t count,
                                       std::size_t dimensions,
                                       std::uint64_t seed,
                                       std::uint64_t index) {
  std::vector<UnitPoint> points(count, UnitPoint(dimensions));
  Random random(seed, Purpose::design, index);
  std::vector<std::size_t> slices(count);
  for (std::size_t k = 0; k < dimensions; ++k) {
    std::iota(slices.begin(), slices.end(), std::size_t{0});
    for (std::size_t i = count; i > 1;
         --i) {  // Fisher-Yates: std::shuffle differs between libraries
      const auto j = static_cast<std::size_t>(random.uniform() * static_cast<double>(i));
      std::swap(slices[i - 1], slices[j]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      points[i][k] =
          (static_cast<double>(slices[i]) + random.uniform()) / static_cast<double>(count);
    }
  }
  return points;
}

double smallest_distance(const std::vector<UnitPoint>& points) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      smallest = std::min(smallest, distance(points[i], points[j]));
    }
  }
  return smallest;
}

namespace {

/// Of 30 designs one that has the most points, and of those the one whose closest two are farthest
/// apart.
template <class Make>
std::vector<UnitPoint> farthest_apart(std::uint64_t index, const Make& make) {
  constexpr std::uint64_t attempts = 30;
  std::vector<UnitPoint> best;
  std::pair<std::size_t, double> best_of{0, -1.0};
  for (std::uint64_t attempt = 0; attempt < attempts; ++attempt) {
    std::vector<UnitPoint> points = make(index * attempts + attempt);
    const std::pair of{points.size(), smallest_distance(points)};
    if (of > best_of) {
      best_of = of;
      best = std::move(points);
    }
  }
  return best;
}

}  // namespace

std::vector<UnitPoint> spread_design(std::size_t count,
                                     std::size_t dimensions,
                                     std::uint64_t seed,
                                     std::uint64_t index) {
  return farthest_apart(
      index, [&](std::uint64_t which) { return latin_hypercube(count, dimensions, seed, which); });
}

std::vector<UnitPoint> allowed_points(const SearchSpace& space,
                                      std::size_t count,
                                      std::uint64_t seed,
                                      std::uint64_t index) {
  constexpr std::uint64_t candidates = 100'000;
  const std::uint64_t rounds =
      std::max<std::uint64_t>(1, candidates / std::max(count, std::size_t{1}));
  std::vector<UnitPoint> points;
  for (std::uint64_t round = 0; round < rounds && points.size() < count; ++round) {
    for (UnitPoint& point :
         latin_hypercube(count, space.dimensions(), seed, index + (round << 32U))) {
      if (points.size() < count && space.allows(point)) points.push_back(std::move(point));
    }
  }
  return points;
}

std::vector<UnitPoint> spread_design(const SearchSpace& space,
                                     std::size_t count,
                                     std::uint64_t seed,
                                     std::uint64_t index) {
  return farthest_apart(
      index, [&](std::uint64_t which) { return allowed_points(space, count, seed, which); });
}

}  // namespace repose::calibrator
