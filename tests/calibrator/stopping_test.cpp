#include "calibrator/stopping.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/known_ledger.hpp"

using namespace repose;
using namespace repose::calibrator;

namespace {

SiteRun seen(double y0, double y1) { return {0, {y0, y1}, true, 0.0}; }

}  // namespace

TEST_CASE("replicates within a standard error of every target are a hit", "[calibrator]") {
  toy::Known known(toy::two_of_three(0.1), 8);
  const double y0 = known.study().calibration.measurements[0].value;
  const double y1 = known.study().calibration.measurements[1].value;
  const std::vector<SiteRun> good{seen(y0 + 0.1, y1), seen(y0 + 0.2, y1 - 0.1), seen(y0, y1)};
  CHECK(is_hit(known.ledger(), good));
  const std::vector<SiteRun> off{seen(y0 + 0.6, y1), seen(y0 + 0.6, y1), seen(y0 + 0.6, y1)};
  CHECK_FALSE(is_hit(known.ledger(), off));
  // The mean is perfect, its error is not.
  const std::vector<SiteRun> wild{seen(y0 + 2.0, y1), seen(y0 - 2.0, y1), seen(y0, y1)};
  CHECK_FALSE(is_hit(known.ledger(), wild));
}

TEST_CASE("replicates of which one failed are no hit", "[calibrator]") {
  toy::Known known(toy::two_of_three(0.1), 8);
  const double y0 = known.study().calibration.measurements[0].value;
  const double y1 = known.study().calibration.measurements[1].value;
  const std::vector<SiteRun> runs{seen(y0, y1), seen(std::nan(""), y1), seen(y0, y1)};
  CHECK_FALSE(is_hit(known.ledger(), runs));
}

TEST_CASE("replicates far from a target are given up, those near it are not", "[calibrator]") {
  toy::Known known(toy::two_of_three(0.5), 8);
  const double y0 = known.study().calibration.measurements[0].value;
  const double y1 = known.study().calibration.measurements[1].value;
  // Standard errors of the measurements are 0.5; the mean of four runs is good to about 0.13.
  const std::vector<SiteRun> near(4, seen(y0 + 0.6, y1));
  CHECK_FALSE(is_hit(known.ledger(), near));
  CHECK(may_be_hit(known.ledger(), near));
  CHECK_FALSE(may_be_hit(known.ledger(), std::vector<SiteRun>(4, seen(y0 + 1.5, y1))));
  std::vector<SiteRun> failed(4, seen(y0, y1));
  CHECK(may_be_hit(known.ledger(), failed));
  failed[2] = seen(std::nan(""), y1);
  CHECK_FALSE(may_be_hit(known.ledger(), failed));
}

TEST_CASE("the noisier the simulation, the more replicates confirm it", "[calibrator]") {
  toy::Known quiet(toy::two_of_three(0.1), 8);
  toy::Known noisy(toy::two_of_three(1.5), 8);
  CHECK(confirming_replicates(quiet.ledger()) == 4);
  CHECK(confirming_replicates(noisy.ledger()) == 8);
}

TEST_CASE("the promise of a hit is high at the truth and nil far away", "[calibrator]") {
  const toy::Known known(toy::two_of_three(0.1), 15);
  CHECK(probability_of_hit(known.outlook(), known.study().truth, 4) > 0.95);
  CHECK(probability_of_hit(known.outlook(), {0.9, 0.1, 0.5}, 4) < 1e-6);
}

TEST_CASE("nothing better is left once the emulator knows the minimum", "[calibrator]") {
  const toy::Known known(toy::two_of_three(0.1), 20, 4);
  CHECK(probability_of_better(known.outlook(), recommend(known.outlook(), {})) <= 0.05);
}

TEST_CASE("something better is left while the recommended point is a bad one", "[calibrator]") {
  const toy::Known known(toy::two_of_three(0.1), 20, 4);
  CHECK(probability_of_better(known.outlook(), {0.9, 0.1, 0.5}) > 0.95);
}

TEST_CASE("targets beyond the reach of the model are implausible everywhere", "[calibrator]") {
  const toy::Known reachable(toy::two_of_three(0.1), 15);
  CHECK(least_implausibility(reachable.outlook(), recommend(reachable.outlook(), {})) < 1.0);

  toy::Study study = toy::two_of_three(0.1);
  study.calibration.measurements[0].value = 15.0;  // the largest y0 is 10.1, sigma 0.5
  const toy::Known known(std::move(study), 15);
  CHECK(least_implausibility(known.outlook(), recommend(known.outlook(), {})) > 3.0);
}
