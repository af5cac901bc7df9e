#include "server/nightly/drift.hpp"

#include <cmath>
#include <utility>

#include <catch2/catch.hpp>

#include "engine/random.hpp"

using namespace repose::server;

namespace {

/// Points until an alarm, the value being shifted from point `at` on; of unequal standard errors.
std::pair<int, int> points_to_alarm(std::uint64_t seed, double limit, double shift, int at) {
  repose::engine::Random random(seed, repose::engine::Purpose::trial);
  Drift drift;
  int points = 0;
  int early = 0;
  while (points < 1'000'000) {
    const double error = 0.5 + random.uniform();
    const double value = 7.0 + error * random.normal() + (points >= at ? shift : 0.0);
    drift = advance(drift, {value, error}, limit);
    ++points;
    if (!drift.alarm) continue;
    if (points > at) break;
    ++early;
  }
  return {points, early};
}

}  // namespace

TEST_CASE("the limit of a chart gives the mean run length that is published for it", "[server]") {
  // Lucas & Saccucci 1990, Technometrics 32, 1-12, table 3: weight 0.2, run length 500.
  CHECK(limit_for(500.0) == Approx(2.962).epsilon(0.002));
  CHECK(run_length(2.962) == Approx(500.0).epsilon(0.01));
  CHECK(run_length(limit_for(7000.0)) == Approx(7000.0).epsilon(0.001));
}

TEST_CASE("where nothing moves a chart alarms no oftener than is stated", "[server]") {
  const double limit = limit_for(200.0);
  double points = 0.0;
  constexpr int runs = 2000;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    points += points_to_alarm(seed, limit, 0.0, 0).first;
  }
  // Run lengths are nearly exponential: the mean of 2000 has a standard error of 2.2 %.
  CHECK(points / runs > 200.0 * (1.0 - 0.045));
  CHECK(points / runs < 200.0 * 1.15);
}

TEST_CASE("a shift of two standard errors is found within a fortnight, mostly", "[server]") {
  const double limit = limit_for(7000.0);
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    const auto [points, early] = points_to_alarm(seed, limit, 2.0, 60);
    if (points - 60 <= 14) ++found;
  }
  CHECK(found > 475);
}

TEST_CASE("after an alarm a chart begins anew", "[server]") {
  const double limit = limit_for(500.0);
  Drift drift;
  for (int i = 0; i < 20; ++i) drift = advance(drift, {1.0, 0.1}, limit);
  CHECK(drift.level == 0.0);
  while (!drift.alarm) drift = advance(drift, {2.0, 0.1}, limit);
  drift = advance(drift, {2.0, 0.1}, limit);
  CHECK(drift.points == 1);
  CHECK(drift.centre == 2.0);
  CHECK_FALSE(drift.alarm);
}
