#include "calibrator/misfit.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "engine/catalogue.hpp"

using namespace repose;
using calibrator::Measurement;
using calibrator::Role;
using calibrator::Suite;

namespace {

Measurement measured(const char* experiment, const char* observable, double value, double error) {
  Measurement m;
  m.experiment.name = experiment;
  m.observable = observable;
  m.value = value;
  m.standard_error = error;
  return m;
}

std::vector<Measurement> three() {
  std::vector<Measurement> all{measured("drum", "angle", 30.0, 1.0),
                               measured("kettle", "density", 700.0, 7.0),
                               measured("drum", "width", 0.2, 0.01)};
  all[2].experiment.fidelity = engine::Fidelity::paper;  // fidelity does not tell them apart
  return all;
}

engine::Evaluation answer(std::vector<engine::Observation> observations) {
  return {{}, std::move(observations), {}};
}

}  // namespace

TEST_CASE("observables of one experiment share one trial", "[calibrator]") {
  const auto measurements = three();
  const Suite suite(measurements);
  REQUIRE(suite.size() == 2);
  std::vector<engine::Trial> trials;
  suite.append_trials({}, engine::Fidelity::draft, 7, trials);
  REQUIRE(trials.size() == 2);
  CHECK(trials[0].experiment.name == "drum");
  CHECK(trials[1].experiment.name == "kettle");
  CHECK(trials[0].experiment.fidelity == engine::Fidelity::draft);
  CHECK(trials[0].seed == 7);
}

TEST_CASE("experiments with other settings are other experiments", "[calibrator]") {
  auto measurements = three();
  measurements[2].experiment.settings["speed"] = 1.5;
  CHECK(Suite(measurements).size() == 3);
}

TEST_CASE("a default that is spelt out is the same question", "[calibrator]") {
  std::vector<Measurement> measurements{measured("drop", "restitution", 0.6, 0.01),
                                        measured("drop", "restitution", 0.61, 0.01)};
  measurements[1].experiment.settings["height"] =
      engine::find_experiment("drop")->settings.front().null_value;
  REQUIRE(engine::find_experiment("drop")->settings.front().name == "height");
  CHECK(Suite(measurements).size() == 1);
  CHECK(Suite(measurements).place_of(measurements[1].experiment) == std::optional<std::size_t>{0});
  measurements[1].experiment.settings["height"] *= 2.0;
  CHECK(Suite(measurements).size() == 2);

  // A draft's default spelt out is another question at standard.
  std::vector<Measurement> boxes{measured("tilting_box", "static_angle", 0.5, 0.01),
                                 measured("tilting_box", "static_angle", 0.5, 0.01)};
  const auto settings = engine::find_experiment("tilting_box")->settings;
  REQUIRE(settings.front().name == "length");
  boxes[1].experiment.settings["length"] = settings.front().draft;
  CHECK(Suite(boxes).size() == 2);
}

TEST_CASE("a failed experiment gives NaN for its observables only", "[calibrator]") {
  const auto measurements = three();
  const Suite suite(measurements);
  const std::vector<engine::Evaluation> evaluations{
      {{}, engine::Failure{engine::FailureKind::unstable, "", 0.0}, {}},
      answer({{"density", 714.0}})};
  const auto values = suite.read(evaluations);
  CHECK(std::isnan(values[0]));
  CHECK(values[1] == 714.0);
  CHECK(std::isnan(values[2]));
  CHECK(std::isnan(calibrator::misfit(measurements, values)));
}

TEST_CASE("an observable that was not reported is NaN", "[calibrator]") {
  const auto measurements = three();
  const std::vector<engine::Evaluation> evaluations{answer({{"width", 0.21}}),
                                                    answer({{"density", 714.0}})};
  const auto values = Suite(measurements).read(evaluations);
  CHECK(std::isnan(values[0]));
  CHECK(values[2] == 0.21);
}

TEST_CASE("the misfit is the sum of squared z over the fitted measurements", "[calibrator]") {
  auto measurements = three();
  measurements[0].allowance = 0.75;  // with 1.0: 1.25
  measurements[2].role = Role::held_out;
  const std::vector<double> values{32.5, 714.0, 0.9};
  const auto z = calibrator::standardised_residuals(measurements, values);
  CHECK(z[0] == Approx(2.0));
  CHECK(z[1] == Approx(2.0));
  CHECK(z[2] == Approx(70.0));
  CHECK(calibrator::misfit(measurements, values) == Approx(8.0));
}

TEST_CASE("a held-out experiment that failed leaves the misfit as it is", "[calibrator]") {
  auto measurements = three();
  measurements[2].role = Role::held_out;
  CHECK(calibrator::misfit(measurements, std::vector<double>{30.0, 707.0, std::nan("")}) ==
        Approx(1.0));
}
