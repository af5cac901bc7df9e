#include "calibrator/known_runs.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

#include "calibrator/ledger.hpp"

using namespace repose;
using namespace repose::calibrator;
using engine::MaterialId;

namespace {

const engine::ParameterKey restitution =
    engine::make_key("restitution.coefficient", {MaterialId::grain, MaterialId::wall});
const engine::ParameterKey density = engine::make_key("material.density", {MaterialId::grain});
const engine::ParameterKey drag = engine::make_key("air_drag.share", {MaterialId::grain});

/// Restitution free between 0.3 and 0.9; a drop from two heights.
Calibration drops() {
  Calibration calibration;
  calibration.fixed.set(density, 1200.0);
  calibration.free.push_back({restitution, 0.3, 0.9, {}, {}});
  for (const double height : {0.1, 0.3}) {
    Measurement measurement;
    measurement.experiment.name = "drop";
    measurement.experiment.settings["height"] = height;
    measurement.observable = "restitution";
    measurement.value = 0.6;
    measurement.standard_error = 0.01;
    calibration.measurements.push_back(measurement);
  }
  return calibration;
}

/// What a store has of one drop; it gives back what it was asked for.
engine::Evaluation drop(double e, double height, std::uint64_t seed, double of_density = 1200.0) {
  engine::Evaluation evaluation;
  evaluation.trial.parameters.set(density, of_density);
  evaluation.trial.parameters.set(restitution, e);
  evaluation.trial.experiment.name = "drop";
  evaluation.trial.experiment.settings["height"] = height;
  evaluation.trial.experiment.fidelity = engine::Fidelity::standard;
  evaluation.trial.seed = seed;
  evaluation.outcome = std::vector<engine::Observation>{{"restitution", e}};
  return evaluation;
}

std::vector<double> first_values(const std::vector<KnownRun>& runs) {
  std::vector<double> values;
  for (const KnownRun& run : runs) values.push_back(run.values.front());
  return values;
}

}  // namespace

TEST_CASE("stored answers make a run where every experiment of the suite is there",
          "[calibrator]") {
  const std::vector<engine::Evaluation> stored{
      drop(0.5, 0.1, 1), drop(0.5, 0.3, 1), drop(0.6, 0.1, 2), drop(0.6, 0.3, 3)};
  const auto known = known_runs(drops(), stored);
  REQUIRE(known.size() == 1);  // the others have two seeds
  CHECK(known.front().values == std::vector<double>{0.5, 0.5});
  CHECK(known.front().level == Level::search);
}

TEST_CASE("the order in which runs were answered says nothing", "[calibrator]") {
  std::vector<engine::Evaluation> stored;
  for (const double e : {0.7, 0.4, 0.55}) {
    for (const double height : {0.1, 0.3}) {
      for (const std::uint64_t seed : {9, 2}) stored.push_back(drop(e, height, seed));
    }
  }
  const auto forwards = first_values(known_runs(drops(), stored));
  std::ranges::reverse(stored);
  CHECK(forwards.size() == 6);
  CHECK(first_values(known_runs(drops(), stored)) == forwards);
}

TEST_CASE("a run at another fixed value, or outside the bounds, is none of this study's",
          "[calibrator]") {
  for (const auto& [e, of_density] : {std::pair{0.5, 1300.0}, std::pair{0.95, 1200.0}}) {
    CAPTURE(e, of_density);
    const std::vector<engine::Evaluation> stored{drop(e, 0.1, 1, of_density),
                                                 drop(e, 0.3, 1, of_density)};
    CHECK(known_runs(drops(), stored).empty());
  }
}

TEST_CASE("to say that an effect is absent is to say nothing", "[calibrator]") {
  std::vector<engine::Evaluation> stored{drop(0.5, 0.1, 1), drop(0.5, 0.3, 1)};
  for (engine::Evaluation& evaluation : stored) evaluation.trial.parameters.set(drag, 0.0);
  CHECK(known_runs(drops(), stored).size() == 1);
  for (engine::Evaluation& evaluation : stored) evaluation.trial.parameters.set(drag, 1.0);
  CHECK(known_runs(drops(), stored).empty());
}

TEST_CASE("runs know enough once every parameter was tried away from its commonest value",
          "[calibrator]") {
  const Calibration calibration = drops();
  const auto enough = [&](const std::vector<double>& tried, int least) {
    std::vector<engine::Evaluation> stored;
    for (std::size_t i = 0; i < tried.size(); ++i) {
      for (const double height : {0.1, 0.3}) stored.push_back(drop(tried[i], height, i));
    }
    const auto known = known_runs(calibration, stored);
    const Evaluator none;
    return know_enough(Ledger(calibration, none, known), least);
  };
  CHECK_FALSE(enough({}, 1));
  CHECK_FALSE(enough({0.5, 0.5}, 1));
  CHECK(enough({0.5, 0.6}, 1));
  CHECK_FALSE(enough({0.5, 0.6}, 2));
  CHECK(enough({0.5, 0.6, 0.7}, 2));
}
