#include "calibrator/recheck.hpp"

#include <catch2/catch.hpp>

#include "calibrator/calibrate.hpp"
#include "tests/support/toy_study.hpp"

using namespace repose;
using namespace repose::calibrator;

namespace {

/// y0 = 10 u0, y1 = 10 u1, with a little noise.
toy::Study study() {
  toy::Study study;
  study.response = [](std::span<const double> u) {
    return std::vector<double>{10.0 * u[0], 10.0 * u[1]};
  };
  study.sigma = {0.5, 0.5};
  study.truth = {0.4, 0.6};
  study.noise = 0.1;
  return toy::ask(std::move(study), 1, 60, 4);
}

std::vector<KnownRun> runs_of(const Fit& fit) {
  std::vector<KnownRun> runs;
  for (const HistoryPoint& point : fit.history) {
    runs.push_back({point.parameters, Level::search, point.values, 1.0});
  }
  return runs;
}

}  // namespace

TEST_CASE("an answer holds while its measurements stay, and no longer once they move",
          "[calibrator]") {
  const toy::Study toy_study = study();
  const Evaluator evaluator = toy::evaluator(toy_study);
  const Published published{toy_study.calibration, calibrate(toy_study.calibration, evaluator)};
  REQUIRE(published.fit.stop == StopReason::hit);
  const auto known = runs_of(published.fit);

  Calibration tonight = toy_study.calibration;
  tonight.seed = 77;
  const Recheck same = recheck(tonight, published, evaluator, known);
  CHECK(same.passed);
  CHECK(same.fit.stop == StopReason::hit);
  CHECK(same.fit.evaluations >= 4);
  CHECK(same.runs.size() == static_cast<std::size_t>(same.fit.evaluations));
  REQUIRE(same.estimate.size() == 2);
  CHECK(same.estimate[0].determined);
  CHECK(same.estimate[0].value == Approx(published.fit.parameters[0].value).margin(0.03));

  // What is measured moves: the set does not, the estimate does.
  tonight.measurements[0].value += 2.0;
  const Recheck moved = recheck(tonight, published, evaluator, known);
  CHECK_FALSE(moved.passed);
  CHECK(moved.fit.best == same.fit.best);
  CHECK(moved.estimate[0].value == Approx(same.estimate[0].value + 0.2).margin(0.05));
  CHECK(moved.estimate[1].value == Approx(same.estimate[1].value).margin(0.05));
}

TEST_CASE("an answer that never hit holds as long as it is no worse", "[calibrator]") {
  const toy::Study toy_study = study();
  const Evaluator evaluator = toy::evaluator(toy_study);
  Published published{toy_study.calibration, calibrate(toy_study.calibration, evaluator)};
  // Published against another value: 1.5 standard errors off, and that is known.
  for (auto* calibration : {&published.calibration}) calibration->measurements[0].value += 0.75;
  published.fit.predictions[0].z = -1.5;
  Calibration tonight = published.calibration;
  CHECK(recheck(tonight, published, evaluator, runs_of(published.fit)).passed);
  tonight.measurements[0].value += 0.5;
  CHECK_FALSE(recheck(tonight, published, evaluator, runs_of(published.fit)).passed);
}

TEST_CASE("what the confirming fidelity adds is told with the answer, known anew or taken over",
          "[calibrator]") {
  toy::Study toy_study = study();
  toy_study.calibration.budget.fidelity = engine::Fidelity::draft;
  toy_study.calibration.budget.confirm_fidelity = engine::Fidelity::standard;
  constexpr double added = 1.5;  // to the first observable, by the standard apparatus
  const Evaluator plain = toy::evaluator(toy_study);
  const Evaluator evaluator = [&](std::span<const engine::Trial> trials) {
    auto answers = plain(trials);
    for (engine::Evaluation& answer : answers) {
      if (answer.trial.experiment.fidelity != engine::Fidelity::standard) continue;
      std::get<std::vector<engine::Observation>>(answer.outcome).front().value += added;
    }
    return answers;
  };
  toy_study.calibration.measurements[0].value += added;
  const Published published{toy_study.calibration, calibrate(toy_study.calibration, evaluator)};
  REQUIRE(published.fit.stop == StopReason::hit);
  std::vector<KnownRun> known;
  for (const HistoryPoint& point : published.fit.history) {
    const bool confirmed = point.stage == "pair" || point.stage == "confirm";
    known.push_back(
        {point.parameters, confirmed ? Level::confirm : Level::search, point.values, 1.0});
  }
  Calibration tonight = toy_study.calibration;
  tonight.seed = 77;
  const Recheck anew = recheck(tonight, published, evaluator, known);
  REQUIRE(anew.fit.offset.size() == 2);
  CHECK(anew.fit.offset[0] == Approx(added).margin(0.3));
  CHECK(anew.fit.offset[1] == Approx(0.0).margin(0.3));
  CHECK(anew.fit.offset_error[0] > 0.0);
  const Recheck alone = recheck(tonight, published, evaluator, {});
  CHECK(alone.fit.offset == published.fit.offset);
  CHECK(alone.fit.offset_error == published.fit.offset_error);
}

TEST_CASE("without runs to learn from the replicates alone decide", "[calibrator]") {
  const toy::Study toy_study = study();
  const Evaluator evaluator = toy::evaluator(toy_study);
  const Published published{toy_study.calibration, calibrate(toy_study.calibration, evaluator)};
  const Recheck alone = recheck(toy_study.calibration, published, evaluator, {});
  CHECK(alone.passed);
  CHECK(alone.estimate.empty());
  CHECK(alone.fit.parameters.size() == 2);
  CHECK(alone.fit.remarks.size() == 1);
}
