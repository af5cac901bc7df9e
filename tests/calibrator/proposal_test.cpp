#include "calibrator/proposal.hpp"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/known_ledger.hpp"

using namespace repose;
using namespace repose::calibrator;

TEST_CASE("the expected misfit counts the distance and the doubt", "[calibrator]") {
  const toy::Known known(toy::two_of_three(0.2), 15);
  const UnitPoint u{0.1, 0.9, 0.5};
  double sum = 0.0;
  for (const Target& target : known.outlook().targets) {
    const Belief belief = known.outlook().surrogate.at(target.measurement, u);
    sum += (std::pow(belief.mean - target.value, 2) + belief.variance) / 0.25;
  }
  CHECK(expected_misfit(known.outlook(), u) == Approx(sum));
}

TEST_CASE("the recommended point solves a study that the emulator has understood", "[calibrator]") {
  const toy::Known known(toy::two_of_three(0.1), 15);
  const UnitPoint best = recommend(known.outlook(), {});
  // 30 runs of scatter 0.05 on a slope of 10: a hundredth of the range and more are certain.
  CHECK(best[0] == Approx(0.4).margin(0.02));
  CHECK(best[1] == Approx(0.6).margin(0.02));
}

TEST_CASE("a batch has the size asked for, in the cube, the same each time", "[calibrator]") {
  const toy::Known known(toy::two_of_three(0.5), 8);
  const UnitPoint best = recommend(known.outlook(), {});
  const auto batch = propose(known.outlook(), best, 4, 0);
  REQUIRE(batch.size() == 4);
  for (const UnitPoint& point : batch) {
    for (const double u : point) CHECK((u >= 0.0 && u <= 1.0));
  }
  CHECK(batch == propose(known.outlook(), best, 4, 0));
}

TEST_CASE("points of a batch keep apart while there is much to gain", "[calibrator]") {
  // Few, poor samples of a wavy response: everything is still to be learnt.
  toy::Study study;
  study.response = [](std::span<const double> u) {
    return std::vector<double>{10.0 * std::sin(6.0 * u[0] + 2.0 * u[1]), 8.0 * u[1] * u[0]};
  };
  study.sigma = {0.2, 0.2};
  study.truth = {0.3, 0.7};
  const toy::Known known(toy::ask(std::move(study), 3, 60, 4), 6, 1);
  const auto batch = propose(known.outlook(), recommend(known.outlook(), {}), 4, 0);
  CHECK(smallest_distance(batch) > 0.02);
  const std::vector<UnitPoint> exploring(batch.begin() + 1, batch.end());  // the first one exploits
  CHECK(smallest_distance(exploring) > 0.1);
}

TEST_CASE("the vote on feasibility follows the nearest sites", "[calibrator]") {
  std::vector<Site> sites;
  for (int i = 0; i < 20; ++i) {
    const double u = (i + 0.5) / 20.0;
    sites.push_back({{u}, {SiteRun{0, {u < 0.5 ? 1.0 : std::nan("")}, u < 0.5, 0.0}}, {}});
  }
  const Feasibility feasibility(sites);
  CHECK(feasibility.at(UnitPoint{0.1}) == Approx(1.0));
  CHECK(feasibility.at(UnitPoint{0.9}) == Approx(1e-3));
  CHECK(feasibility.at(UnitPoint{0.5}) ==
        Approx(0.5).margin(0.2));  // five voters, split three to two
}

TEST_CASE("where nothing failed everything is feasible", "[calibrator]") {
  const std::vector<Site> sites{{{0.5}, {SiteRun{0, {1.0}, true, 0.0}}, {}}};
  CHECK(Feasibility(sites).at(UnitPoint{0.0}) == 1.0);
}

TEST_CASE("cost is learnt from grain-steps", "[calibrator]") {
  std::vector<Site> sites;
  for (const UnitPoint& u : latin_hypercube(10, 2, 1)) {
    sites.push_back({u, {SiteRun{0, {1.0}, true, 1e6 * std::exp(3.0 * u[1])}}, {}});
  }
  const CostModel cost(sites);
  // Exactly linear data: only the ridge of 1e-6 is left.
  CHECK(cost.logarithm_at(UnitPoint{0.2, 0.9}) - cost.logarithm_at(UnitPoint{0.7, 0.1}) ==
        Approx(2.4).epsilon(1e-4));
}

TEST_CASE("without grain-steps every point costs the same", "[calibrator]") {
  const std::vector<Site> sites{{{0.5}, {SiteRun{0, {1.0}, true, 0.0}}, {}}};
  CHECK(CostModel(sites).logarithm_at(UnitPoint{0.1}) == 0.0);
}

TEST_CASE("a point next to a site that is as good becomes a replicate of it", "[calibrator]") {
  const toy::Known known(toy::two_of_three(0.5), 8);
  const UnitPoint site = known.outlook().ledger.sites()[3].at;
  UnitPoint near = site;
  near[2] += near[2] < 0.5 ? 0.01 : -0.01;  // the direction without effect
  CHECK(settle(known.outlook(), near) == site);
  UnitPoint far = site;
  far[0] += far[0] < 0.5 ? 0.2 : -0.2;
  CHECK(settle(known.outlook(), far) == far);
}
