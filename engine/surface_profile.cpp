#include "engine/surface_profile.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace repose::engine {

namespace {

constexpr double bare = -std::numeric_limits<double>::infinity();

double place_of(const Places& places, std::size_t index) {
  return places.from +
         (static_cast<double>(index) + 0.5) * (places.to - places.from) / places.count;
}

/// Raises the tops at the points that a grain covers. `along`: where the grain's centre is along
/// the slope; `point(i, k)`: of place i, from the grain's centre in the plane.
template <class Point>
void raise(std::vector<double>& tops,
           const GrainRow& g,
           double along,
           const Places& places,
           const Point& point) {
  const auto points = static_cast<std::size_t>(places.points);
  for (std::size_t i = 0; i < static_cast<std::size_t>(places.count); ++i) {
    if (std::abs(place_of(places, i) - along) >= g.radius) continue;
    for (std::size_t k = 0; k < points; ++k) {
      const Vec3 off = point(place_of(places, i), (static_cast<double>(k) + 0.5) / places.points);
      const double rise = g.radius * g.radius - dot(off, off);
      if (rise <= 0.0) continue;
      double& top = tops[i * points + k];
      top = std::max(top, g.z + std::sqrt(rise));
    }
  }
}

SurfaceProfile mean_of(const std::vector<double>& tops, const Places& places) {
  const auto points = static_cast<std::size_t>(places.points);
  SurfaceProfile profile(static_cast<std::size_t>(places.count));
  for (std::size_t i = 0; i < profile.size(); ++i) {
    double sum = 0.0;
    int met = 0;
    for (std::size_t k = i * points; k < (i + 1) * points; ++k) {
      if (tops[k] == bare) continue;
      sum += tops[k];
      ++met;
    }
    profile[i] = {.place = place_of(places, i),
                  .height = met > 0 ? sum / met : 0.0,
                  .covered = static_cast<double>(met) / places.points};
  }
  return profile;
}

std::vector<double> bare_points(const Places& places) {
  return std::vector<double>(
      static_cast<std::size_t>(places.count) * static_cast<std::size_t>(places.points), bare);
}

}  // namespace

SurfaceProfile ring_profile(const World& world, const Places& places) {
  std::vector<double> tops = bare_points(places);
  const double width = (places.to - places.from) / places.count;
  for (const GrainRow& g : world.grains().rows) {
    const double ring = std::floor((std::hypot(g.x, g.y) - places.from) / width);
    if (ring < 0.0 || ring >= places.count) continue;
    const double share = std::atan2(g.y, g.x) / (2.0 * unit::pi) + 0.5;
    const int sector = std::min(static_cast<int>(share * places.points), places.points - 1);
    double& top = tops[static_cast<std::size_t>(ring) * static_cast<std::size_t>(places.points) +
                       static_cast<std::size_t>(sector)];
    top = std::max(top, g.z + g.radius);
  }
  return mean_of(tops, places);
}

SurfaceProfile straight_profile(const World& world,
                                const Places& places,
                                const std::function<bool(const GrainRow&)>& of_bed) {
  const double width = world.period().y;
  std::vector<double> tops = bare_points(places);
  for (const GrainRow& g : world.grains().rows) {
    if (of_bed && !of_bed(g)) continue;
    raise(tops, g, g.x, places, [&g, width](double x, double share) {
      return Vec3{x - g.x, std::remainder(share * width - g.y, width), 0.0};
    });
  }
  return mean_of(tops, places);
}

SurfaceProfile covered_places(const SurfaceProfile& profile) {
  SurfaceProfile covered;
  std::ranges::copy_if(
      profile, std::back_inserter(covered), [](const auto& p) { return p.covered >= 0.5; });
  return covered;
}

LineFit line_through(const SurfaceProfile& profile) {
  std::vector<double> x(profile.size());
  std::vector<double> y(profile.size());
  std::ranges::transform(profile, x.begin(), &SurfaceHeight::place);
  std::ranges::transform(profile, y.begin(), &SurfaceHeight::height);
  return fit_line(x, y);
}

double roughness(const SurfaceProfile& profile, const LineFit& line) {
  double sum = 0.0;
  for (const SurfaceHeight& p : profile) {
    const double off = p.height - (line.intercept + line.slope * p.place);
    sum += off * off;
  }
  return std::sqrt(sum / static_cast<double>(profile.size()));
}

}  // namespace repose::engine
