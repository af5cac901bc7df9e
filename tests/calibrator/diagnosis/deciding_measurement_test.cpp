#include "calibrator/diagnosis/deciding_measurement.hpp"

#include <algorithm>
#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "engine/catalogue.hpp"

using namespace repose;
using calibrator::Calibration;
using calibrator::Candidate;
using calibrator::Measurement;
using calibrator::Rival;

namespace {

const engine::ParameterKey key = engine::make_key("stand_in.x", {});

engine::ParameterSet at(double x) {
  engine::ParameterSet set;
  set.set(key, x);
  return set;
}

/// "steep" follows the parameter, "flat" does not, "blind" is never observed.
std::vector<engine::Evaluation> answer(std::span<const engine::Trial> trials) {
  std::vector<engine::Evaluation> evaluations;
  for (const engine::Trial& trial : trials) {
    const double x = trial.parameters.get_or(key, 0.0);
    engine::Evaluation evaluation{trial, {}, {}};
    evaluation.outcome =
        std::vector<engine::Observation>{{"steep", 10.0 * x}, {"flat", 1.0}, {"gentle", x}};
    evaluations.push_back(std::move(evaluation));
  }
  return evaluations;
}

Candidate candidate(const std::string& observable) {
  Measurement measurement;
  measurement.experiment.name = "bench";
  measurement.observable = observable;
  measurement.standard_error = 0.5;
  return {measurement};
}

}  // namespace

TEST_CASE("what rivals foretell alike, or nobody observes, settles nothing", "[calibrator]") {
  const Calibration calibration;
  const std::vector<Candidate> candidates{
      candidate("flat"), candidate("gentle"), candidate("blind"), candidate("steep")};
  const std::vector<Rival> rivals{{{at(1.0), at(1.01)}, 0.5}, {{at(2.0), at(2.01)}, 0.5}};
  const auto next = calibrator::weigh_candidates(calibration, candidates, rivals, answer);
  REQUIRE(next.size() == 2);
  CHECK(next[0].observable == "steep");
  CHECK(next[1].observable == "gentle");
  CHECK(next[0].predicted[0] == Approx(10.05));
  CHECK(next[0].predicted[1] == Approx(20.05));
  CHECK(next[1].evidence == Approx(1.0 / 0.25).epsilon(0.01));
  CHECK(next[0].gain == Approx(0.25 * 12.0));  // more evidence than that is not needed
}

TEST_CASE("a rival that does not know itself what to expect is settled by nothing",
          "[calibrator]") {
  const Calibration calibration;
  const std::vector<Candidate> candidates{candidate("gentle")};
  const std::vector<Rival> rivals{{{at(0.0), at(4.0)}, 0.5}, {{at(1.0), at(5.0)}, 0.5}};
  CHECK(calibrator::weigh_candidates(calibration, candidates, rivals, answer).empty());
}

TEST_CASE("candidates are every experiment but what the study has, at conditions that differ",
          "[calibrator]") {
  Calibration calibration;
  Measurement own;
  own.experiment = {"drum", engine::Fidelity::standard, {}};
  own.observable = "dynamic_angle";
  own.value = 0.6;
  own.standard_error = 0.05;
  calibration.measurements = {own};
  const auto candidates = calibrator::candidates_of(calibration, {});
  std::set<std::string> experiments;
  for (const Candidate& candidate : candidates) {
    const Measurement& measurement = candidate.measurement;
    experiments.insert(measurement.experiment.name);
    if (measurement.experiment.name == "drum") {
      CHECK(measurement.experiment.settings.contains("speed"));
      CHECK(candidate.relative_error > 0.1);  // as the study's own angle, and the tolerance
    }
    for (const auto& [name, value] : measurement.experiment.settings) {
      const auto* info = engine::find_experiment(measurement.experiment.name);
      const auto field = std::ranges::find(info->settings, name, &engine::FieldInfo::name);
      REQUIRE(field != info->settings.end());
      CHECK(value >= field->lower);
      CHECK(value <= field->upper);
    }
  }
  CHECK(experiments.size() == engine::experiment_catalogue().size());
}
