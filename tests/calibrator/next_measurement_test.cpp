#include "calibrator/next_measurement.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "calibrator/calibrate.hpp"
#include "engine/random.hpp"
#include "tests/support/toy_study.hpp"

using namespace repose;
using namespace repose::calibrator;

namespace {

/// A tilting box whose static angle tells of the first parameter, its onset angle of the second.
Fit solve(bool measure_onset, double static_error = 0.02, double onset_error = 0.02) {
  Calibration c;
  c.name = "box";
  c.budget.evaluations = 40;
  for (std::size_t k = 0; k < 2; ++k) {
    c.free.push_back({engine::make_key(toy::parameter(k), {}), 0.0, 1.0, {}, {}});
  }
  Measurement angle;
  angle.experiment.name = "tilting_box";
  angle.observable = "static_angle";
  angle.value = 0.6;
  angle.standard_error = static_error;
  angle.unit = engine::unit::radian;
  c.measurements.push_back(angle);
  if (measure_onset) {
    angle.observable = "onset_angle";
    angle.value = 0.4;
    angle.standard_error = onset_error;
    c.measurements.push_back(angle);
  }
  const SearchSpace space(c);
  return calibrate(c, [&](std::span<const engine::Trial> trials) {
    std::vector<engine::Evaluation> answers;
    for (const engine::Trial& trial : trials) {
      const UnitPoint u = space.coordinates(trial.parameters);
      engine::Random random(trial.seed, engine::Purpose::grain_position);
      answers.push_back({trial,
                         std::vector<engine::Observation>{
                             {"static_angle", 0.4 + 0.4 * u[0] + 0.002 * random.normal()},
                             {"onset_angle", 0.2 + 0.4 * u[1] + 0.002 * random.normal()}},
                         {}});
    }
    return answers;
  });
}

}  // namespace

TEST_CASE("what the runs show of an open parameter is the measurement that would teach most",
          "[calibrator]") {
  const Fit fit = solve(false);
  CHECK_FALSE(fit.parameters[1].determined);
  REQUIRE(fit.next.size() == 2);
  CHECK(fit.next[0].observable == "onset_angle");
  CHECK_FALSE(fit.next[0].again);
  CHECK(fit.next[0].parameter == 1);
  CHECK(fit.next[0].learnt > 0.9);
  // As relatively well as the one that was measured: its tangent's error is of that share.
  CHECK(fit.next[0].standard_error ==
        Approx(0.02 / std::sin(2 * 0.6) * std::sin(2 * fit.next[0].predicted)).epsilon(0.01));
  CHECK(fit.next[1].observable == "static_angle");
  CHECK(fit.next[1].again);
  CHECK(fit.next[1].standard_error == Approx(0.01));
}

TEST_CASE("what is open counts for more than knowing better what is known", "[calibrator]") {
  // The static angle is known far better than is needed; the onset angle hardly tells anything.
  const Fit fit = solve(true, 0.0005, 0.1);
  REQUIRE(!fit.next.empty());
  CHECK(fit.next[0].observable == "onset_angle");
  CHECK(fit.next[0].parameter == 1);
  for (const NextMeasurement& next : fit.next) CHECK(next.observable != "static_angle");
}

TEST_CASE("where all is measured there is only measuring it better", "[calibrator]") {
  const Fit fit = solve(true);
  REQUIRE(fit.next.size() == 2);
  CHECK(fit.next[0].again);
  CHECK(fit.next[1].again);
  CHECK(fit.next[0].gain >= fit.next[1].gain);
}
