/// Grains: the spheres of a run, a row each. Rows are re-ordered as grains move; ids stay.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/vec3.hpp"

namespace repose::engine {

/// State of one grain: what a contact reads of its ends lies together.
struct alignas(32) GrainRow {
  double x = 0.0, y = 0.0, z = 0.0;     ///< centre, m
  double radius = 0.0;                  ///< m
  double vx = 0.0, vy = 0.0, vz = 0.0;  ///< m/s
  double inverse_mass = 0.0;            ///< 1/kg
  double wx = 0.0, wy = 0.0, wz = 0.0;  ///< spin, rad/s
  double inverse_inertia = 0.0;         ///< 1/(kg m2)

  [[nodiscard]] Vec3 centre() const { return {x, y, z}; }
  [[nodiscard]] Vec3 velocity() const { return {vx, vy, vz}; }
  [[nodiscard]] Vec3 spin() const { return {wx, wy, wz}; }
};

/// Force and torque on one grain during a step: one cache line.
struct alignas(64) GrainLoad {
  double fx = 0.0, fy = 0.0, fz = 0.0;  ///< N
  double no_force = 0.0;                ///< a fourth, so that both are quads
  double tx = 0.0, ty = 0.0, tz = 0.0;  ///< N m
  double no_torque = 0.0;
};

/// Stands for the body of a sphere that is no member of a clump.
inline constexpr std::uint32_t no_body = std::numeric_limits<std::uint32_t>::max();

struct Grains {
  std::vector<GrainRow> rows;
  std::vector<GrainLoad> loads;
  std::vector<std::uint32_t> ids;

  [[nodiscard]] std::size_t size() const { return rows.size(); }
};

/// A sphere of that radius and density, at rest.
GrainRow sphere(double radius, double density);

inline double mass(const GrainRow& grain) { return 1.0 / grain.inverse_mass; }

}  // namespace repose::engine
