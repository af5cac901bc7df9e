// The draw-down from a silo.
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/trials.hpp"

using namespace repose::engine;
using namespace repose::tests;
using Catch::Contains;

namespace {

Trial small_silo() {
  Trial t = trial_of("draw_down");
  t.experiment.settings = small_settings("draw_down");
  return t;
}

}  // namespace

TEST_CASE("a silo that arches is a failure that says so, not a rate", "[engine]") {
  Trial t = small_silo();
  t.experiment.settings["slot"] = 0.0196;
  set_friction(t, 1.5, 0.0);
  for (const MaterialId partner : {MaterialId::grain, MaterialId::wall}) {
    t.parameters.set({"elastic_rolling_resistance.coefficient", {MaterialId::grain, partner}}, 0.8);
  }
  const Failure failure = failure_in(evaluate(t));
  CHECK(failure.kind == FailureKind::not_observed);
  CHECK_THAT(failure.message, Contains("arched"));
}

TEST_CASE("a silo that runs empty has a rate and no slope, though a grain rolls on", "[engine]") {
  Trial t = small_silo();
  set_friction(t, 0.02, GENERATE(0.02, 0.0));
  const Evaluation evaluation = evaluate(t);
  CHECK(value_in(evaluation, 0) > 1.0);  // kg/(s m)
  CHECK(std::abs(value_in(evaluation, 1)) < 1.0 * unit::degree.factor);
}

TEST_CASE("a silo too small for its grains is refused", "[engine]") {
  for (const auto& [name, value] : {std::pair{"slot", 0.015},
                                    std::pair{"width", 0.015},
                                    std::pair{"depth", 0.02},
                                    std::pair{"length", 0.08}}) {
    CAPTURE(name, value);
    Trial t = small_silo();
    t.experiment.settings[name] = value;
    const Evaluation evaluation = evaluate(t);
    CHECK(failure_in(evaluation).kind == FailureKind::bad_input);
    CHECK_THAT(failure_in(evaluation).message, Contains(name));
    CHECK(evaluation.effort.steps == 0);
  }
}

TEST_CASE("a wider slot passes more per length of slot, as its width to the power of 3/2",
          "[engine][slow]") {
  // Beverloo's law for a slot: rate ~ (slot - k d)^(3/2), k between 1 and 2 (Beverloo et al. 1961).
  const double d = 6.496e-3;
  const auto rate = [](double slot) {
    Trial t = trial_of("draw_down");
    t.experiment.settings = {{"slot", slot}, {"length", 0.12 + slot}, {"depth", 0.10}};
    return mean_of_seeds(t, 0, 2);
  };
  const double narrow = rate(0.035);
  const double wide = rate(0.055);
  const auto beverloo = [d](double k) { return std::pow((0.055 - k * d) / (0.035 - k * d), 1.5); };
  CHECK(wide / narrow > beverloo(0.5));
  CHECK(wide / narrow < beverloo(2.5));
}

TEST_CASE("more friction flows slower and stays steeper", "[engine][slow]") {
  const auto measure = [](double sliding, double rolling, std::size_t observable) {
    Trial t = trial_of("draw_down");
    set_friction(t, sliding, rolling);
    return mean_of_seeds(t, observable, 3);
  };
  CHECK(measure(0.2, 0.02, 0) > measure(0.6, 0.1, 0));
  CHECK(measure(0.2, 0.02, 1) < measure(0.6, 0.1, 1) - 2.0 * unit::degree.factor);
}
