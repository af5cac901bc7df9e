#include "engine/effects/log_normal_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

using namespace repose::engine;

namespace {

constexpr std::uint64_t draws = 200000;

std::vector<double> volumes(double deviation) {
  std::vector<double> result;
  result.reserve(draws);
  for (std::uint64_t k = 0; k < draws; ++k) {
    Random random(1, Purpose::grain_size, k);
    result.push_back(effects::LogNormalSizes::populate({deviation}, random));
  }
  std::ranges::sort(result);
  return result;
}

}  // namespace

TEST_CASE("log-normal grain volumes have mean one", "[engine]") {
  for (const double deviation : {0.05, 0.2, 0.4}) {
    CAPTURE(deviation);
    double sum = 0.0, squares = 0.0;
    for (const double x : volumes(deviation)) {
      sum += x;
      squares += x * x;
    }
    const double mean = sum / draws;
    const double error = std::sqrt((squares / draws - mean * mean) / draws);
    CHECK(mean == Approx(1.0).margin(5 * error));
  }
}

// Of a standard normal cut at +-2: standard deviation 0.879626, and quantiles as of the whole one
// at shares 0.02275 + 0.9545 q: q = 0.16 is at z = -0.893494 (Phi(-0.893494) = 0.175, NIST tables).
TEST_CASE("logarithms of log-normal diameters have the deviation and quantiles asked for",
          "[engine]") {
  for (const double deviation : {0.05, 0.4}) {
    CAPTURE(deviation);
    const auto x = volumes(deviation);
    double sum = 0.0, squares = 0.0;
    for (const double v : x) {
      const double u = std::log(v) / 3.0;
      sum += u;
      squares += u * u;
    }
    const double mean = sum / draws;
    CHECK(std::sqrt(squares / draws - mean * mean) == Approx(0.879626 * deviation).epsilon(0.01));
    const double median = std::log(x[draws / 2]) / 3.0;
    CHECK(median == Approx(mean).margin(0.01 * deviation));
    const auto share = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
    const double z = -0.9;  // the share of grains below it, after the cut
    const double below = (share(z) - share(-2.0)) / (1.0 - 2.0 * share(-2.0));
    const double at = std::log(x[static_cast<std::size_t>(below * draws)]) / 3.0;
    CHECK((at - median) / deviation == Approx(z).margin(0.015));
    CHECK(x.front() >= effects::LogNormalSizes::smallest({deviation}));
    CHECK(x.back() <= effects::LogNormalSizes::largest({deviation}));
  }
}

TEST_CASE("without a log-normal deviation every grain has exactly the mean volume", "[engine]") {
  Random random(1, Purpose::grain_size, 4);
  CHECK(effects::LogNormalSizes::populate({0.0}, random) == 1.0);
  CHECK(effects::LogNormalSizes::smallest({0.0}) == 1.0);
  CHECK(effects::LogNormalSizes::largest({0.0}) == 1.0);
}
