// The rotating drum.
#include <catch2/catch.hpp>

#include "tests/support/trials.hpp"

using namespace repose::engine;
using namespace repose::tests;
using Catch::Contains;

namespace {

Trial small_drum() {
  Trial t = trial_of("drum");
  t.experiment.settings = small_settings("drum");
  return t;
}

}  // namespace

TEST_CASE("a drum that is too small, too fast or too still is refused", "[engine]") {
  for (const auto& [name, value] : {std::pair{"diameter", 0.06},
                                    std::pair{"length", 0.015},
                                    std::pair{"speed", 0.0},
                                    std::pair{"fill", 0.9},
                                    std::pair{"speed", 18.0}}) {
    CAPTURE(name, value);
    Trial t = small_drum();
    t.experiment.settings[name] = value;
    const Evaluation evaluation = evaluate(t);
    CHECK(failure_in(evaluation).kind == FailureKind::bad_input);
    CHECK_THAT(failure_in(evaluation).message, Contains(name));
    CHECK(evaluation.effort.steps == 0);
  }
}

TEST_CASE("a bed that slides in a smooth drum is a failure that says so and shows itself",
          "[engine]") {
  Trial t = small_drum();
  t.experiment.settings["ribs"] = 0.0;
  set_friction(t, 0.02, 0.02);
  std::string last;
  std::size_t grains = 0;
  Run run;
  run.frames = [&](const Frame& frame) {
    last = frame.stage;
    grains = frame.grains.size();
  };
  const Evaluation evaluation = evaluate(t, run);
  const Failure failure = failure_in(evaluation);
  CHECK(failure.kind == FailureKind::not_observed);
  CHECK_THAT(failure.message, Contains("slides as a whole"));
  CHECK(last == "failed");  // a frame to look at
  CHECK(grains == evaluation.effort.grains);
}

TEST_CASE("the drum turns its bed up on the side that rises", "[engine]") {
  double left = 0.0, right = 0.0;
  Run run;
  run.frames = [&](const Frame& frame) {
    if (frame.stage != "flowing") return;
    for (const FrameGrain& g : frame.grains) (g.centre.x < 0.0 ? left : right) += g.centre.z;
  };
  CHECK(value_in(evaluate(small_drum(), run), 0) > 10.0 * unit::degree.factor);
  CHECK(left > right);
}

TEST_CASE("more friction and more speed stand steeper in the drum", "[engine][slow]") {
  const auto angle = [](double sliding, double rpm) {
    Trial t = trial_of("drum");
    t.experiment.settings["speed"] = rpm * unit::revolution_per_minute.factor;
    set_friction(t, sliding, 0.05);
    return mean_of_seeds(t, 0, 2);
  };
  const double reference = angle(0.45, 15.0);
  CHECK(angle(0.1, 15.0) < reference - 4.0 * unit::degree.factor);
  CHECK(angle(0.45, 45.0) > reference + 4.0 * unit::degree.factor);
}

TEST_CASE("grains that hang from the drum overhead are not of its surface", "[engine][slow]") {
  Trial t = trial_of("drum");
  t.experiment.settings["speed"] = 30.0 * unit::revolution_per_minute.factor;
  for (const MaterialId partner : {MaterialId::grain, MaterialId::wall}) {
    t.parameters.set({"jkr_adhesion.work", {MaterialId::grain, partner}}, 0.3);  // J/m2: they do
  }
  for (t.seed = 1; t.seed <= 3; ++t.seed) {
    CAPTURE(t.seed);
    const double angle = value_in(evaluate(t), 0) / unit::degree.factor;
    CHECK(angle > 38.0);  // less than 31 where they are taken for it
    CHECK(angle < 48.0);
  }
}
