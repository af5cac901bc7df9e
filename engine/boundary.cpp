#include "engine/boundary.hpp"

#include <cmath>

namespace repose::engine {

namespace {

constexpr double endless = 64.0;  // m; beyond any apparatus, and near enough to keep its digits

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

Vec3 offset_from(const Surface& surface, const Vec3& centre) {
  const bool revolved = surface.sweep == Surface::Sweep::revolved;
  const double s = revolved ? std::sqrt(centre.x * centre.x + centre.y * centre.y) : centre.x;
  const double run_s = surface.to_s - surface.from_s;
  const double run_z = surface.to_z - surface.from_z;
  const double squared = run_s * run_s + run_z * run_z;
  const double rel_s = s - surface.from_s;
  const double rel_z = centre.z - surface.from_z;
  const double along = rel_s * run_s + rel_z * run_z;
  double off_s = 0.0, off_z = 0.0;
  if (along <= 0.0) {
    off_s = rel_s;
    off_z = rel_z;
  } else if (along >= squared) {
    off_s = s - surface.to_s;
    off_z = centre.z - surface.to_z;
  } else {
    // Along the profile's normal, so that the digits of a long wall are not lost.
    const double across = (rel_z * run_s - rel_s * run_z) / squared;
    off_s = -across * run_z;
    off_z = across * run_s;
  }
  if (!revolved) return {off_s, 0.0, off_z};
  // On the axis every direction is as near: the x axis stands for them.
  const double x = s > 0.0 ? centre.x / s : 1.0;
  const double y = s > 0.0 ? centre.y / s : 0.0;
  return {off_s * x, off_s * y, off_z};
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
