#include "engine/effects/size_spread.hpp"

#include <cmath>

#include <catch2/catch.hpp>

using namespace repose::engine;

TEST_CASE("grain volumes have mean one and the standard deviation of a normal cut at two",
          "[engine]") {
  for (const double deviation : {0.2, 0.4}) {
    CAPTURE(deviation);
    const effects::SizeSpread::Parameters p{deviation};
    constexpr int draws = 200000;
    double sum = 0.0, squares = 0.0, least = 1e9, most = 0.0;
    for (std::uint64_t k = 0; k < draws; ++k) {
      Random random(1, Purpose::grain_size, k);
      const double x = effects::SizeSpread::populate(p, random);
      sum += x;
      squares += x * x;
      least = std::min(least, x);
      most = std::max(most, x);
    }
    const double mean = sum / draws;
    // Standard deviation of a standard normal cut at +-2: sqrt(1 - 2 * 2 phi(2) / (2 Phi(2) - 1)).
    const double kept = std::sqrt(1.0 - 4.0 * 0.0539909665 / 0.9544997361);
    CHECK(mean == Approx(1.0).margin(5 * deviation / std::sqrt(draws)));
    CHECK(std::sqrt(squares / draws - mean * mean) == Approx(kept * deviation).epsilon(0.01));
    CHECK(least >= effects::SizeSpread::smallest(p));
    CHECK(most <= effects::SizeSpread::largest(p));
  }
}

TEST_CASE("without a spread every grain has exactly the mean volume", "[engine]") {
  Random random(1, Purpose::grain_size, 4);
  CHECK(effects::SizeSpread::populate({0.0}, random) == 1.0);
}
