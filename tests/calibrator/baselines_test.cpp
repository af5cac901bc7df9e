#include <algorithm>
#include <cmath>
#include <stop_token>
#include <string>

#include <catch2/catch.hpp>

#include "calibrator/baselines/baseline.hpp"
#include "calibrator/calibrate.hpp"
#include "tests/support/known_ledger.hpp"
#include "tests/support/toy_study.hpp"

using namespace repose;
using namespace repose::calibrator;

namespace {

toy::Study study_for(Method method, double noise, int evaluations = 120) {
  toy::Study study = toy::two_of_three(noise);
  study.calibration.budget.method = method;
  study.calibration.budget.evaluations = evaluations;
  return study;
}

std::vector<Method> baselines() {
  std::vector<Method> methods;
  for (std::size_t i = 1; i < method_names.size(); ++i) methods.push_back(static_cast<Method>(i));
  return methods;
}

std::string name_of(Method method) {
  return std::string(method_names.at(static_cast<std::size_t>(method)));
}

}  // namespace

TEST_CASE("every baseline comes within one standard error of an easy minimum",
          "[calibrator][slow]") {
  for (const Method method : baselines()) {
    INFO(name_of(method));
    const toy::Study study = study_for(method, 0.01);
    const Fit fit = calibrate(study.calibration, toy::evaluator(study));
    CHECK(fit.stop == StopReason::hit);
    CHECK(toy::truly_hits(study, fit.best));
    CHECK(fit.parameters.size() == 3);
    REQUIRE(fit.predictions.size() == 2);
    // Confirmed by fresh replicates, as ours is.
    CHECK(fit.predictions[0].replicates == 4);
    CHECK(std::ranges::count(fit.history, std::string_view("confirm"), &HistoryPoint::stage) == 4);
    CHECK(fit.remarks.front().find(name_of(method)) != std::string::npos);
  }
}

TEST_CASE("a baseline keeps to its budget and is the same again, bit by bit",
          "[calibrator][slow]") {
  for (const Method method : baselines()) {
    INFO(name_of(method));
    const toy::Study study = study_for(method, 0.5, 43);
    const Fit once = calibrate(study.calibration, toy::evaluator(study));
    const Fit again = calibrate(study.calibration, toy::evaluator(study));
    CHECK(once.evaluations <= 43);
    CHECK(once.best == again.best);
    CHECK(once.misfit == again.misfit);
    REQUIRE(once.history.size() == again.history.size());
    for (std::size_t i = 0; i < once.history.size(); ++i) {
      CHECK(once.history[i].parameters == again.history[i].parameters);
    }
  }
}

TEST_CASE("a baseline that is cancelled stops asking and says its best so far", "[calibrator]") {
  for (const Method method : baselines()) {
    INFO(name_of(method));
    const toy::Study study = study_for(method, 0.1);
    std::stop_source source;
    const auto stop_at_20 = [&](const Progress& now) {
      if (now.evaluations_done >= 20) source.request_stop();
    };
    const Fit fit = calibrate(study.calibration,
                              toy::evaluator(study),
                              {.stop = source.get_token(), .observer = stop_at_20});
    CHECK(fit.stop == StopReason::cancelled);
    CHECK(fit.evaluations >= 20);
    CHECK(fit.evaluations < 40);
    CHECK(!fit.best.empty());
  }
}

TEST_CASE("a baseline survives runs that fail", "[calibrator][slow]") {
  for (const Method method : baselines()) {
    INFO(name_of(method));
    toy::Study study = study_for(method, 0.1);
    study.fails = [](std::span<const double> u) { return u[2] > 0.55; };
    const Fit fit = calibrate(study.calibration, toy::evaluator(study));
    CHECK(fit.stop != StopReason::failed);
    CHECK(std::isfinite(fit.misfit));
  }
}

TEST_CASE("a baseline whose runs all fail says so", "[calibrator]") {
  for (const Method method : baselines()) {
    INFO(name_of(method));
    toy::Study study = study_for(method, 0.1, 30);
    study.fails = [](std::span<const double>) { return true; };
    CHECK(calibrate(study.calibration, toy::evaluator(study)).stop == StopReason::failed);
  }
}

TEST_CASE("a baseline of one parameter", "[calibrator]") {
  for (const Method method : baselines()) {
    INFO(name_of(method));
    toy::Study study;
    study.response = [](std::span<const double> u) { return std::vector<double>{10.0 * u[0]}; };
    study.sigma = {0.5};
    study.truth = {0.3};
    study.noise = 0.05;
    study = toy::ask(std::move(study), 1, 60, 4);
    study.calibration.budget.method = method;
    CHECK(calibrate(study.calibration, toy::evaluator(study)).stop == StopReason::hit);
  }
}
