#include "server/report/view.hpp"

#include <algorithm>
#include <cmath>

namespace repose::server {

using engine::cross;
using engine::Vec3;

namespace {

/// Turns v by the smallest rotation that takes unit vector a to unit vector b (Rodrigues' formula).
Vec3 turn_between(const Vec3& a, const Vec3& b, const Vec3& v) {
  const double cosine = dot(a, b);
  if (cosine < -1.0 + 1e-12) return {v.x, -v.y, -v.z};  // half a turn about x, as good as any
  const Vec3 axis = cross(a, b);
  return v + cross(axis, v) + (1.0 / (1.0 + cosine)) * cross(axis, cross(axis, v));
}

}  // namespace

void Bounds::include(const Vec3& point, double margin) {
  lower = {std::min(lower.x, point.x - margin),
           std::min(lower.y, point.y - margin),
           std::min(lower.z, point.z - margin)};
  upper = {std::max(upper.x, point.x + margin),
           std::max(upper.y, point.y + margin),
           std::max(upper.z, point.z + margin)};
}

Bounds bounds_of(std::span<const engine::FrameGrain> grains) {
  Bounds bounds;
  for (const engine::FrameGrain& grain : grains) bounds.include(grain.centre, grain.radius);
  return bounds;
}

ViewAxes view_axes(const Vec3& gravity, double azimuth, double elevation) {
  const Vec3 toward{std::sin(azimuth) * std::cos(elevation),
                    -std::cos(azimuth) * std::cos(elevation),
                    std::sin(elevation)};
  const Vec3 right{std::cos(azimuth), std::sin(azimuth), 0.0};
  const Vec3 up = cross(toward, right);
  const double strength = norm(gravity);
  const Vec3 down = strength > 0.0 ? (1.0 / strength) * gravity : Vec3{0.0, 0.0, -1.0};
  const auto turned = [&](const Vec3& v) { return turn_between({0.0, 0.0, -1.0}, down, v); };
  return {turned(right), turned(up), turned(toward)};
}

Projection fit(const ViewAxes& axes, const Bounds& turned, int width, int height) {
  constexpr double margin = 0.04;  // of the page, on each side
  const Vec3 size = turned.size(), centre = turned.centre();
  const double wide = std::max(size.x, 1e-9), high = std::max(size.y, 1e-9);
  const double scale = (1.0 - 2.0 * margin) * std::min(width / wide, height / high);
  return {axes, scale, 0.5 * width - scale * centre.x, 0.5 * height + scale * centre.y};
}

}  // namespace repose::server
