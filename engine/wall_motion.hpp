/// WallMotion: walls that move as they are told, each as a rigid body: v + w x (point - pivot).
///
/// The wall goes where its points go, as far as its kind can: a profile along y moves in its plane
/// and turns about y, one round an axis of its own, upright or lying, moves with that axis,
/// rectangles and meshes do everything. Motion along the wall itself, such as a drum's about its
/// axis or a belt's, leaves it where it is. Steps are exact turns about the pivot.
#pragma once

#include "engine/boundary.hpp"

namespace repose::engine {

/// Of the wall's matter at a point, m/s.
inline Vec3 velocity_at(const Surface& surface, const Vec3& point) {
  if (surface.spin == Vec3{}) return surface.velocity;
  return surface.velocity + cross(surface.spin, point - surface.pivot);
}

/// No point of the wall changes its place faster than that, m/s; 0 where the wall stays.
double fastest(const Surface& surface);

/// Moves a wall for a time, s.
void advance(Surface& surface, double dt);

/// What the grains do to a wall.
struct WallLoad {
  Vec3 force;   ///< N
  Vec3 torque;  ///< about its pivot, N m
};

}  // namespace repose::engine
