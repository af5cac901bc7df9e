#include "engine/boundary.hpp"

#include <algorithm>
#include <cmath>

namespace repose::engine {

namespace {

constexpr double endless = 1e3;  // m; far beyond any apparatus

}  // namespace

Surface plane(double z, MaterialId material) { return strip(-endless, endless, z, material); }

Surface strip(double low_x, double high_x, double z, MaterialId material) {
  return {Surface::Sweep::extruded, low_x, z, high_x, z, material, {}};
}

Surface upright(double x, double low, double high, MaterialId material) {
  return {Surface::Sweep::extruded, x, low, x, high, material, {}};
}

Surface cylinder(double radius, double low, double high, MaterialId material) {
  return {Surface::Sweep::revolved, radius, low, radius, high, material, {}};
}

Surface cone(double low_radius, double low, double high_radius, double high, MaterialId material) {
  return {Surface::Sweep::revolved, low_radius, low, high_radius, high, material, {}};
}

Surface disc(double radius, double z, MaterialId material, double inner) {
  return {Surface::Sweep::revolved, inner, z, radius, z, material, {}};
}

Vec3 nearest_point(const Surface& surface, const Vec3& centre) {
  const bool revolved = surface.sweep == Surface::Sweep::revolved;
  const double s = revolved ? std::sqrt(centre.x * centre.x + centre.y * centre.y) : centre.x;
  const double run_s = surface.to_s - surface.from_s;
  const double run_z = surface.to_z - surface.from_z;
  const double along = (s - surface.from_s) * run_s + (centre.z - surface.from_z) * run_z;
  const double t = std::clamp(along / (run_s * run_s + run_z * run_z), 0.0, 1.0);
  const double near_s = surface.from_s + t * run_s;
  const double near_z = surface.from_z + t * run_z;
  if (!revolved) return {near_s, centre.y, near_z};
  // On the axis every direction is as near: the x axis stands for them.
  const double x = s > 0.0 ? centre.x / s : 1.0;
  const double y = s > 0.0 ? centre.y / s : 0.0;
  return {near_s * x, near_s * y, near_z};
}

std::vector<FrameWall> outline(const std::vector<Surface>& surfaces) {
  std::vector<FrameWall> result;
  for (const Surface& s : surfaces) {
    const bool revolved = s.sweep == Surface::Sweep::revolved;
    result.push_back({revolved, s.from_s, s.from_z, s.to_s, s.to_z, 0.0, 0.0});
  }
  return result;
}

}  // namespace repose::engine
