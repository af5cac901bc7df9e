#include "calibrator/draft_help.hpp"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "calibrator/calibrate.hpp"
#include "tests/support/toy_study.hpp"

using namespace repose;
using namespace repose::calibrator;

namespace {

struct Outcome {
  Fit fit;
  int drafts = 0;
  int others = 0;
};

/// Six observables, a draft run for `cost` of the other's grain-steps.
Outcome solve(std::uint64_t cost,
              const std::function<std::vector<double>(std::span<const double>)>& bias) {
  toy::Study study = toy::granular(6, 0.3, 3, 60, 4);
  study.draft_bias = bias;
  study.calibration.budget.draft_runs = 30;
  Outcome outcome;
  const auto evaluator = [&](std::span<const engine::Trial> trials) {
    auto evaluations = toy::evaluator(study)(trials);
    for (auto& evaluation : evaluations) {
      const bool draft = evaluation.trial.experiment.fidelity == engine::Fidelity::draft;
      evaluation.effort.grain_steps = draft ? cost : 100;
      ++(draft ? outcome.drafts : outcome.others);
    }
    return evaluations;
  };
  outcome.fit = calibrate(study.calibration, evaluator);
  return outcome;
}

/// A tenth of the response more, and a constant.
std::vector<double> faithful(std::span<const double> u) {
  std::vector<double> bias = toy::granular_response(u);
  for (double& b : bias) b = 0.1 * b + 0.02;
  return bias;
}

std::vector<double> misleading(std::span<const double> u) {
  const double wave = std::sin(40.0 * u[0] + 25.0 * u[1]);
  return {0.1 * wave, 10.0 * wave, 0.3 * wave, 10.0 * wave, 10.0 * wave, wave};
}

std::ptrdiff_t remarks_with(const Fit& fit, const std::string& words) {
  return std::ranges::count_if(fit.remarks, [&](const std::string& remark) {
    return remark.find(words) != std::string::npos;
  });
}

}  // namespace

TEST_CASE("drafts that follow the dearer runs are used, and not counted", "[calibrator]") {
  const Outcome outcome = solve(15, faithful);
  CHECK(remarks_with(outcome.fit, "Draft runs helped with") == 6);
  CHECK(outcome.drafts == 10 + 30);  // at the start's points, and elsewhere
  CHECK(outcome.fit.evaluations == outcome.others);
  CHECK(outcome.fit.stop == StopReason::hit);
}

TEST_CASE("drafts that mislead are dropped after the proof, and that is said", "[calibrator]") {
  const Outcome outcome = solve(15, misleading);
  CHECK(remarks_with(outcome.fit, "Draft runs were left out of") == 6);
  CHECK(outcome.drafts == 10);
}

TEST_CASE("drafts that cost too much are dropped however faithful", "[calibrator]") {
  const Outcome outcome = solve(30, faithful);
  CHECK(remarks_with(outcome.fit, "at 0.3 of the cost, where R2 of 0.9") == 6);
  CHECK(outcome.drafts == 10);
}
