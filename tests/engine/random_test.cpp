#include "engine/random.hpp"

#include <cmath>

#include <catch2/catch.hpp>

using namespace repose::engine;

TEST_CASE("streams of other seeds, purposes and indices share no numbers", "[engine]") {
  Random a(1, Purpose::grain_size, 0), b(2, Purpose::grain_size, 0);
  Random c(1, Purpose::grain_position, 0), d(1, Purpose::grain_size, 1),
      again(1, Purpose::grain_size, 0);
  const std::uint64_t first = a.bits();
  CHECK(first == again.bits());
  CHECK(first != b.bits());
  CHECK(first != c.bits());
  CHECK(first != d.bits());
}

TEST_CASE("uniform and normal numbers have their moments", "[engine]") {
  constexpr int draws = 100000;
  Random random(5, Purpose::grain_velocity);
  double uniform = 0.0, normal = 0.0, squares = 0.0;
  for (int i = 0; i < draws; ++i) {
    uniform += random.uniform() / draws;
    const double x = random.normal();
    normal += x / draws;
    squares += x * x / draws;
  }
  // Five standard errors of each mean.
  CHECK(uniform == Approx(0.5).margin(5 * 0.2887 / std::sqrt(draws)));
  CHECK(normal == Approx(0.0).margin(5 / std::sqrt(draws)));
  CHECK(squares == Approx(1.0).margin(5 * std::sqrt(2.0 / draws)));
}
