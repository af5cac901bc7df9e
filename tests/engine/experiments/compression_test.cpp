// Uniaxial compression.
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/trials.hpp"

using namespace repose::engine;
using namespace repose::tests;
using Catch::Contains;

namespace {

Trial small_press() {
  Trial t = trial_of("compression");
  t.experiment.settings = small_settings("compression");
  return t;
}

void set_modulus(Trial& t, double shear_modulus) {
  for (const MaterialId material : {MaterialId::grain, MaterialId::wall}) {
    t.parameters.set({"material.shear_modulus", {material}}, shear_modulus);
  }
}

}  // namespace

TEST_CASE("a press too small for its grains, too coarse in time or without speed is refused",
          "[engine]") {
  for (const auto& [name, value] : {std::pair{"side", 0.02},
                                    std::pair{"depth", 0.02},
                                    std::pair{"speed", 0.0},
                                    std::pair{"time_step", 0.25},
                                    std::pair{"overshoot", 1.0}}) {
    CAPTURE(name, value);
    Trial t = small_press();
    t.experiment.settings[name] = value;
    const Evaluation evaluation = evaluate(t);
    CHECK(failure_in(evaluation).kind == FailureKind::bad_input);
    CHECK_THAT(failure_in(evaluation).message, Contains(name));
    CHECK(evaluation.effort.steps == 0);
  }
}

TEST_CASE("a stress that the grains cannot bear is a failure that says so", "[engine]") {
  Trial t = small_press();
  t.experiment.settings["stress"] = 2e6;
  t.experiment.settings["speed"] = 0.1;
  const Failure failure = failure_in(evaluate(t));
  CHECK(failure.kind == FailureKind::unstable);
  CHECK_THAT(failure.message, Contains("too soft"));
}

TEST_CASE("a stress that drowns in the bed's own trembling is a failure that says so", "[engine]") {
  Trial t = small_press();
  t.experiment.settings["stress"] = 10.0;
  const Failure failure = failure_in(evaluate(t));
  CHECK(failure.kind == FailureKind::not_observed);
  CHECK_THAT(failure.message, Contains("does not rise steadily"));
}

TEST_CASE("stiffer grains make a stiffer bed, but not more than Hertz springs", "[engine][slow]") {
  // F ~ E d^(3/2): at one stress the springs' strain goes as E^(-2/3); grains that slide add to it.
  const auto modulus = [](double shear_modulus) {
    Trial t = trial_of("compression");
    set_modulus(t, shear_modulus);
    return mean_of_seeds(t, 0, 2);
  };
  const double ratio = modulus(4.16e6) / modulus(1.04e6);
  CHECK(ratio > 1.5);
  CHECK(ratio < 1.03 * std::pow(4.0, 2.0 / 3.0));
}

TEST_CASE("some of the strain springs back and some does not", "[engine]") {
  const double ratio = value_in(evaluate(small_press()), 1);
  CHECK(ratio > 0.02);
  CHECK(ratio < 0.9);
}
