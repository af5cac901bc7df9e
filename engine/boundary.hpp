/// Boundary: walls without thickness, each a straight profile swept round the z axis or along y.
/// Both faces and the free edges act, so a kettle has a rim and a hopper an orifice.
#pragma once

#include <vector>

#include "engine/frame.hpp"
#include "engine/material.hpp"
#include "engine/vec3.hpp"

namespace repose::engine {

/// A wall. In its half plane (s, z) it runs from (from_s, from_z) to (to_s, to_z); s is the
/// distance from the z axis (revolved) or x (extruded along y). Lengths in m.
struct Surface {
  enum class Sweep { extruded, revolved };
  Sweep sweep = Sweep::extruded;
  double from_s = 0.0, from_z = 0.0;
  double to_s = 0.0, to_z = 0.0;
  MaterialId material = MaterialId::wall;  ///< grain: covered with grains' stuff
  Vec3 velocity;                           ///< of its points, m/s
};

/// z = const over all x and y.
Surface plane(double z, MaterialId material = MaterialId::wall);
/// z = const between two values of x, endless along y.
Surface strip(double low_x, double high_x, double z, MaterialId material = MaterialId::wall);
/// x = const, from z = low to high, endless along y.
Surface upright(double x, double low, double high, MaterialId material = MaterialId::wall);
/// The mantle of a cylinder round the z axis.
Surface cylinder(double radius, double low, double high, MaterialId material = MaterialId::wall);
/// The mantle of a truncated cone round the z axis.
Surface cone(double low_radius,
             double low,
             double high_radius,
             double high,
             MaterialId material = MaterialId::wall);
/// A flat disc, with a hole where inner > 0.
Surface disc(double radius, double z, MaterialId material = MaterialId::wall, double inner = 0.0);

/// From the nearest point of a surface to a centre.
Vec3 offset_from(const Surface& surface, const Vec3& centre);

/// The surfaces as a picture needs them.
std::vector<FrameWall> outline(const std::vector<Surface>& surfaces);

}  // namespace repose::engine
