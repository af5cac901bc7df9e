#include "engine/quaternion.hpp"

#include <cmath>

#include <catch2/catch.hpp>

using namespace repose::engine;

TEST_CASE("turning by a product is turning by one factor after the other", "[engine]") {
  const Quaternion a = normalised({0.9, 0.2, -0.3, 0.1}), b = normalised({0.4, -0.7, 0.2, 0.6});
  const Vec3 v{0.3, -1.2, 0.8};
  CHECK(norm(turned(a * b, v) - turned(a, turned(b, v))) < 1e-15);
  CHECK(norm(turned(conjugate(a), turned(a, v)) - v) < 1e-15);
  // A quarter turn about z.
  const double half = std::sqrt(0.5);
  CHECK(norm(turned({half, 0.0, 0.0, half}, {1.0, 0.0, 0.0}) - Vec3{0.0, 1.0, 0.0}) < 1e-15);
}

TEST_CASE("random orientations have no preferred direction", "[engine]") {
  Random random(5, Purpose::grain_position);
  constexpr int draws = 100000;
  Vec3 mean, squares;
  for (int k = 0; k < draws; ++k) {
    const Vec3 axis = turned(random_orientation(random), {0.6, 0.0, 0.8});
    mean += (1.0 / draws) * axis;
    squares += (1.0 / draws) * Vec3{axis.x * axis.x, axis.y * axis.y, axis.z * axis.z};
  }
  // Standard errors: sqrt(1/3 / draws) and sqrt(4/45 / draws).
  CHECK(norm(mean) < 4 * std::sqrt(1.0 / draws));
  for (const double mean_square : {squares.x, squares.y, squares.z}) {
    CHECK(mean_square == Approx(1.0 / 3.0).margin(4 * std::sqrt(4.0 / 45.0 / draws)));
  }
}
