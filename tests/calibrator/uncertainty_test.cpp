#include "calibrator/uncertainty.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/known_ledger.hpp"

using namespace repose;
using namespace repose::calibrator;

TEST_CASE("the interval of a linear parameter is 1.96 standard errors to either side",
          "[calibrator]") {
  // y0 = 10 u0 known to 0.5: u0 known to 0.05.
  const toy::Known known(toy::two_of_three(0.02), 20);
  const auto intervals = profile_intervals(known.outlook(), recommend(known.outlook(), {}));
  // The third parameter moves y0 by 0.1 at most, 0.01 in u0; the emulator's doubt adds less.
  CHECK(intervals[0].lower == Approx(0.4 - 1.96 * 0.05).margin(0.015));
  CHECK(intervals[0].upper == Approx(0.4 + 1.96 * 0.05).margin(0.015));
  CHECK_FALSE(intervals[0].lower_at_bound);
  CHECK_FALSE(intervals[0].upper_at_bound);
}

TEST_CASE("a parameter that the data ignore has the whole range for its interval", "[calibrator]") {
  const toy::Known known(toy::two_of_three(0.02), 20);
  const UnitPoint best = recommend(known.outlook(), {});
  const auto intervals = profile_intervals(known.outlook(), best);
  CHECK(intervals[2].lower_at_bound);
  CHECK(intervals[2].upper_at_bound);
  CHECK(intervals[2].lower == 0.0);
  CHECK(intervals[2].upper == 1.0);
  const Learnt learnt = learnt_directions(known.outlook(), best);
  CHECK(learnt.share[2] < 0.05);
  CHECK(learnt.share[0] > 0.9);
}

TEST_CASE("an interval narrower than the grid is still an interval", "[calibrator]") {
  toy::Study study;
  study.response = [](std::span<const double> u) { return std::vector<double>{1000.0 * u[0]}; };
  study.sigma = {1.0};
  study.truth = {0.4123};
  const toy::Known known(toy::ask(std::move(study), 1, 60, 4), 8);
  const auto intervals = profile_intervals(known.outlook(), recommend(known.outlook(), {}));
  CHECK(intervals[0].lower < 0.4123);
  CHECK(intervals[0].upper > 0.4123);
  // u0 is known to 0.001; the grid's width is 0.025.
  CHECK(intervals[0].upper - intervals[0].lower == Approx(2.0 * 1.96 * 0.001).epsilon(0.1));
}

TEST_CASE("an interval that a constraint ends was not set by the data", "[calibrator]") {
  toy::Study study = toy::two_of_three(0.02);
  study.calibration.constraints.push_back({{{study.calibration.free[0].key, 1.0}}, 0.38, {}});
  const toy::Known known(std::move(study), 20);
  const auto intervals = profile_intervals(known.outlook(), {0.38, 0.6, 0.5});
  CHECK(intervals[0].upper_at_bound);
  CHECK(intervals[0].upper == Approx(0.38).margin(1e-3));
  CHECK_FALSE(intervals[0].lower_at_bound);
  CHECK_FALSE(intervals[1].upper_at_bound);
}

TEST_CASE("directions are orthonormal, best-learnt first, as many as there are parameters",
          "[calibrator]") {
  const toy::Known known(toy::two_of_three(0.1), 15);
  const Learnt learnt = learnt_directions(known.outlook(), recommend(known.outlook(), {}));
  REQUIRE(learnt.directions.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double product = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        product += learnt.directions[i].components[k] * learnt.directions[j].components[k];
      }
      CHECK(product == Approx(i == j ? 1.0 : 0.0).margin(1e-12));
    }
  }
  CHECK(learnt.directions[0].posterior_to_prior <= learnt.directions[1].posterior_to_prior);
  CHECK(learnt.directions[1].learnt);
  CHECK_FALSE(learnt.directions[2].learnt);
  // lambda = (10 / 0.5)^2 = 400: sqrt(12 / 412) = 0.171; the emulator's slope is within a tenth.
  CHECK(learnt.directions[1].posterior_to_prior == Approx(0.171).epsilon(0.1));
}

TEST_CASE("a noisier simulation widens the intervals", "[calibrator]") {
  const auto width = [](double noise) {
    const toy::Known known(toy::two_of_three(noise), 10, 1);
    const auto interval = profile_intervals(known.outlook(), recommend(known.outlook(), {}))[0];
    return interval.upper - interval.lower;
  };
  CHECK(width(2.0) > 1.2 * width(0.05));
}

TEST_CASE("a learnt direction is the product of powers that the data fix, and as well as they do",
          "[calibrator]") {
  // Both parameters from 1 to 100 by their logarithms; measured is log(x0 sqrt(x1)) to 0.05.
  toy::Study study;
  study.response = [](std::span<const double> u) {
    return std::vector<double>{std::log(100.0) * (u[0] + 0.5 * u[1])};
  };
  study.sigma = {0.05};
  study.truth = {0.4, 0.6};
  study.noise = 0.01;
  study = toy::ask(std::move(study), 1, 60, 4);
  for (auto& free : study.calibration.free) {
    free.lower = 1.0;
    free.upper = 100.0;
    free.scale = Scale::log;
  }
  const toy::Known known(std::move(study), 20);
  const Learnt learnt = learnt_directions(known.outlook(), recommend(known.outlook(), {}));
  REQUIRE(learnt.directions[0].learnt);
  CHECK(learnt.directions[0].powers[0] == Approx(1.0));
  CHECK(learnt.directions[0].powers[1] == Approx(0.5).margin(0.01));
  CHECK(learnt.directions[0].product_error == Approx(0.05).margin(0.003));
  CHECK_FALSE(learnt.directions[1].learnt);
}

TEST_CASE("what a prior tells is not counted as learnt from the data", "[calibrator]") {
  toy::Study study = toy::two_of_three(0.02);
  study.calibration.free[0].prior = Prior{0.4, 0.02};  // the data know it to 0.05
  const toy::Known known(std::move(study), 20);
  const UnitPoint best = recommend(known.outlook(), {});
  const Learnt learnt = learnt_directions(known.outlook(), best);
  // Precisions 1/0.02^2 of the prior and 1/0.05^2 of the data.
  CHECK(learnt.share[0] == Approx(400.0 / (400.0 + 2500.0 + 12.0)).margin(0.02));
  const auto intervals = profile_intervals(known.outlook(), best);
  CHECK(intervals[0].upper - intervals[0].lower ==
        Approx(2 * 1.96 / std::sqrt(2900.0)).margin(0.01));
}
