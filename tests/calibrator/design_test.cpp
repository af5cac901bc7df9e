#include "calibrator/design.hpp"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

using namespace repose::calibrator;

TEST_CASE("a Latin hypercube has one point in every slice of every axis", "[calibrator]") {
  for (const std::size_t count : {1UL, 7UL, 20UL}) {
    const auto points = latin_hypercube(count, 5, 3);
    for (std::size_t k = 0; k < 5; ++k) {
      std::vector<int> hits(count, 0);
      for (const UnitPoint& point : points) {
        REQUIRE(point[k] >= 0.0);
        REQUIRE(point[k] < 1.0);
        ++hits[static_cast<std::size_t>(point[k] * static_cast<double>(count))];
      }
      CHECK(std::ranges::all_of(hits, [](int h) { return h == 1; }));
    }
  }
}

TEST_CASE("a design is decided by its seed and index alone", "[calibrator]") {
  CHECK(spread_design(10, 4, 5) == spread_design(10, 4, 5));
  CHECK(spread_design(10, 4, 5) != spread_design(10, 4, 6));
  CHECK(spread_design(10, 4, 5, 0) != spread_design(10, 4, 5, 1));
}

TEST_CASE("a spread design is wider apart than every hypercube it was chosen from",
          "[calibrator]") {
  const double chosen = smallest_distance(spread_design(10, 3, 9));
  for (std::uint64_t i = 0; i < 30; ++i) {
    CHECK(chosen >= smallest_distance(latin_hypercube(10, 3, 9, i)));
  }
}

TEST_CASE("coordinates of a hypercube are uniform and uncorrelated", "[calibrator]") {
  const auto points = latin_hypercube(1000, 2, 1);
  double mean = 0.0;
  double product = 0.0;
  for (const UnitPoint& p : points) {
    mean += p[0] / 1000.0;
    product += (p[0] - 0.5) * (p[1] - 0.5) / 1000.0;
  }
  CHECK(std::abs(mean - 0.5) < 0.5 / 1000.0);  // each slice holds one: off by half a slice at most
  // Correlation of a random permutation has deviation 1 / sqrt(999); four of them.
  CHECK(std::abs(product * 12.0) < 4.0 / std::sqrt(999.0));
}

TEST_CASE("a design keeps the constraints, and without any is the plain one",
          "[calibrator][slow]") {
  Calibration c;
  for (const char* name : {"toy.u0", "toy.u1", "toy.u2"}) {
    c.free.push_back({repose::engine::make_key(name, {}), 0.0, 1.0, {}, {}});
  }
  CHECK(spread_design(SearchSpace(c), 10, 5) == spread_design(10, 3, 5));
  c.constraints.push_back({{{c.free[0].key, 1.0}, {c.free[1].key, 1.0}}, 0.5, {}});  // an eighth
  const auto points = spread_design(SearchSpace(c), 10, 5);
  CHECK(points.size() == 10);
  for (const UnitPoint& point : points) CHECK(point[0] + point[1] <= 0.5);
  c.constraints.front().bound = 0.005;  // 1 in 80,000: an attempt of 100,000 finds one or two
  std::size_t fewest = 10;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    fewest = std::min(fewest, spread_design(SearchSpace(c), 4, seed).size());
  }
  CHECK(fewest >= 2);  // of thirty attempts the one that found most, not the loneliest point
  c.constraints.front().bound = -0.1;
  CHECK(spread_design(SearchSpace(c), 10, 5).empty());
}
