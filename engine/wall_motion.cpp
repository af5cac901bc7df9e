#include "engine/wall_motion.hpp"

#include <algorithm>
#include <cmath>

namespace repose::engine {

namespace {

using Sweep = Surface::Sweep;

/// Farthest end of a profile along y from its axis of spin, m.
double profile_reach(const Surface& s) {
  return std::max(std::hypot(s.from_s - s.pivot.x, s.from_z - s.pivot.z),
                  std::hypot(s.to_s - s.pivot.x, s.to_z - s.pivot.z));
}

/// No point of a rectangle or mesh is farther from the pivot, m.
double placed_reach(const Surface& s) {
  Vec3 middle;
  double half = std::hypot(s.plate.half_a, s.plate.half_b);
  if (s.sweep == Sweep::mesh) {
    const Box& box = s.mesh->box(s.patch);
    middle = 0.5 * (box.low + box.high);
    half = 0.5 * norm(box.high - box.low);
  }
  return norm(s.pose.origin + turned(s.pose.turn, middle) - s.pivot) + half;
}

Quaternion turn_by(const Vec3& spin, double dt) {
  const double rate = norm(spin);
  if (rate == 0.0) return {};
  const double half = 0.5 * rate * dt, share = std::sin(half) / rate;
  return {std::cos(half), share * spin.x, share * spin.y, share * spin.z};
}

/// A point of a profile along y, turned about the pivot and moved.
void advance_profile_end(const Surface& surface, double dt, double& s, double& z) {
  const double angle = surface.spin.y * dt;
  const double x = s - surface.pivot.x, up = z - surface.pivot.z;
  const double turn_x =
      angle == 0.0 ? s : surface.pivot.x + x * std::cos(angle) + up * std::sin(angle);
  const double turn_z =
      angle == 0.0 ? z : surface.pivot.z + up * std::cos(angle) - x * std::sin(angle);
  s = turn_x + surface.velocity.x * dt;
  z = turn_z + surface.velocity.z * dt;
}

void advance_pose(Surface& s, double dt) {
  if (!(s.spin == Vec3{})) {
    const Quaternion turn = turn_by(s.spin, dt);
    s.pose.origin = s.pivot + turned(turn, s.pose.origin - s.pivot);
    s.pose.turn = normalised(turn * s.pose.turn);
  }
  s.pose.origin += dt * s.velocity;
}

}  // namespace

double fastest(const Surface& s) {
  if (s.belt || (s.velocity == Vec3{} && s.spin == Vec3{})) return 0.0;
  switch (s.sweep) {
    case Sweep::extruded:
      return std::hypot(s.velocity.x, s.velocity.z) +
             (s.spin.y != 0.0 ? std::abs(s.spin.y) * profile_reach(s) : 0.0);
    case Sweep::revolved:
    case Sweep::lying:
      return norm(s.velocity);
    case Sweep::rectangle:
    case Sweep::mesh:
      return norm(s.velocity) + norm(s.spin) * placed_reach(s);
  }
  return 0.0;
}

void advance(Surface& s, double dt) {
  if (s.belt) return;
  switch (s.sweep) {
    case Sweep::extruded:
      advance_profile_end(s, dt, s.from_s, s.from_z);
      advance_profile_end(s, dt, s.to_s, s.to_z);
      break;
    case Sweep::revolved:
      s.from_z += s.velocity.z * dt;
      s.to_z += s.velocity.z * dt;
      s.axis_x += s.velocity.x * dt;
      s.axis_y += s.velocity.y * dt;
      break;
    case Sweep::lying:
      s.axis_x += s.velocity.x * dt;
      s.axis_z += s.velocity.z * dt;
      break;
    case Sweep::rectangle:
    case Sweep::mesh:
      advance_pose(s, dt);
      break;
  }
  s.pivot += dt * s.velocity;
}

}  // namespace repose::engine
