/// Quaternion: an orientation. q turns a vector of the body into the same vector in space.
#pragma once

#include <cmath>

#include "engine/random.hpp"
#include "engine/vec3.hpp"

namespace repose::engine {

struct Quaternion {
  double w = 1.0;
  double x = 0.0, y = 0.0, z = 0.0;

  constexpr bool operator==(const Quaternion&) const = default;
};

/// First turned by b, then by a.
constexpr Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
          a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

/// The turn back.
constexpr Quaternion conjugate(const Quaternion& q) { return {q.w, -q.x, -q.y, -q.z}; }

constexpr Vec3 turned(const Quaternion& q, const Vec3& v) {
  const Vec3 axis{q.x, q.y, q.z};
  const Vec3 t = 2.0 * cross(axis, v);
  return v + q.w * t + cross(axis, t);
}

inline Quaternion normalised(const Quaternion& q) {
  const double scale = 1.0 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {scale * q.w, scale * q.x, scale * q.y, scale * q.z};
}

/// An orientation without preference (Marsaglia 1972, Ann. Math. Stat. 43, 645-646).
inline Quaternion random_orientation(Random& random) {
  const auto in_disc = [&random](double& a, double& b) {
    double squared = 2.0;
    while (squared >= 1.0) {
      a = random.uniform(-1.0, 1.0);
      b = random.uniform(-1.0, 1.0);
      squared = a * a + b * b;
    }
    return squared;
  };
  double a = 0.0, b = 0.0, c = 0.0, d = 0.0;
  const double first = in_disc(a, b);
  double second = in_disc(c, d);
  while (second == 0.0) second = in_disc(c, d);
  const double scale = std::sqrt((1.0 - first) / second);
  return normalised({a, b, c * scale, d * scale});
}

}  // namespace repose::engine
