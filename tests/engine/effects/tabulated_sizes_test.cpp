#include "engine/effects/tabulated_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "engine/session.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;

namespace {

using Sizes = effects::TabulatedSizes;

constexpr std::uint64_t draws = 200000;

std::vector<double> volumes(const Sizes::Parameters& p) {
  std::vector<double> result;
  result.reserve(draws);
  for (std::uint64_t k = 0; k < draws; ++k) {
    Random random(1, Purpose::grain_size, k);
    result.push_back(Sizes::populate(p, random));
  }
  std::ranges::sort(result);
  return result;
}

/// The diameter over that of mean volume below which that share of the mass lies.
double passing(const std::vector<double>& sorted, double share) {
  double mass = 0.0;
  for (const double v : sorted) mass += v;
  double below = 0.0;
  for (const double v : sorted) {
    below += v;
    if (below >= share * mass) return std::cbrt(v);
  }
  return 0.0;
}

}  // namespace

TEST_CASE("a sieve curve drawn from has the d10, d50 and d90 it was given", "[engine]") {
  for (const Sizes::Parameters p : {Sizes::Parameters{0.8, 1.1}, {0.5, 2.0}, {1.0, 1.4}}) {
    CAPTURE(p.d10_over_d50, p.d90_over_d50);
    const auto x = volumes(p);
    const double d50 = std::cbrt(Sizes::scale(p));
    CHECK(passing(x, 0.1) / d50 == Approx(p.d10_over_d50).epsilon(0.01));
    CHECK(passing(x, 0.5) / d50 == Approx(1.0).epsilon(0.01));
    CHECK(passing(x, 0.9) / d50 == Approx(p.d90_over_d50).epsilon(0.01));
    // Straight over the logarithm: the quarter lies between the tenth and the median.
    const double quarter = std::pow(p.d10_over_d50, 0.25 / 0.4);
    CHECK(passing(x, 0.25) / d50 == Approx(quarter).epsilon(0.01));
  }
}

TEST_CASE("grain volumes of a sieve curve have mean one and keep to its ends", "[engine]") {
  for (const Sizes::Parameters p : {Sizes::Parameters{0.8, 1.1}, {0.5, 2.0}}) {
    double sum = 0.0, squares = 0.0;
    const auto x = volumes(p);
    for (const double v : x) {
      sum += v;
      squares += v * v;
    }
    const double mean = sum / draws;
    CHECK(mean == Approx(1.0).margin(5 * std::sqrt((squares / draws - mean * mean) / draws)));
    CHECK(x.front() >= Sizes::smallest(p));
    CHECK(x.back() <= Sizes::largest(p));
    // Ends a quarter of the way from the tenth, or the ninetieth, to the median beyond it.
    CHECK(std::cbrt(Sizes::largest(p) / Sizes::smallest(p)) ==
          Approx(std::pow(p.d90_over_d50 / p.d10_over_d50, 1.25)));
  }
}

TEST_CASE("a sieve curve of one size gives every grain exactly the mean volume", "[engine]") {
  Random random(1, Purpose::grain_size, 4);
  CHECK(Sizes::populate({1.0, 1.0}, random) == 1.0);
  CHECK(Sizes::smallest({1.0, 1.0}) == 1.0);
  CHECK(Sizes::largest({1.0, 1.0}) == 1.0);
}

TEST_CASE("two size distributions at once are refused, with both names", "[engine]") {
  Trial trial;
  trial.parameters = repose::tests::parameters({});
  const ExperimentInfo& drop = *find_experiment("drop");
  trial.parameters.set({"log_normal_sizes.deviation", {MaterialId::grain}}, 0.2);
  CHECK(check(drop, trial).empty());
  trial.parameters.set({"size_spread.deviation", {MaterialId::grain}}, 0.0);
  CHECK(check(drop, trial).empty());
  trial.parameters.set({"size_spread.deviation", {MaterialId::grain}}, 0.1);
  CHECK_THAT(check(drop, trial), Catch::Contains("size_spread and log_normal_sizes"));
}
