// The heap on a disc.
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/trials.hpp"

using namespace repose::engine;
using namespace repose::tests;
using Catch::Contains;

namespace {

Trial small_heap() {
  Trial t = trial_of("heap");
  t.experiment.settings = small_settings("heap");
  return t;
}

}  // namespace

TEST_CASE("grains that neither rub nor resist rolling form no heap, and it says so", "[engine]") {
  Trial t = small_heap();
  set_friction(t, 0.0, 0.0);
  const Failure failure = failure_in(evaluate(t));
  CHECK(failure.kind == FailureKind::not_observed);
  CHECK_THAT(failure.message, Contains("no heap formed"));
}

TEST_CASE("a filling too small for its disc is no heap, and it says so", "[engine]") {
  Trial t = small_heap();
  t.experiment.settings["fill"] = 0.034;
  t.experiment.settings["disc_diameter"] = 0.12;
  const Failure failure = failure_in(evaluate(t));
  CHECK(failure.kind == FailureKind::not_observed);
  CHECK_THAT(failure.message, Contains("no grain fell off"));
}

TEST_CASE(
    "the few grains that stick in the cylinder are carried off, a filling that sticks is told",
    "[engine]") {
  // J/m2: a grain hangs on a wall by four times its weight, the filling by forty.
  const auto sticky = [](double work) {
    Trial t = small_heap();
    for (const MaterialId partner : {MaterialId::grain, MaterialId::wall}) {
      t.parameters.set({"jkr_adhesion.work", {MaterialId::grain, partner}}, work);
    }
    return evaluate(t);
  };
  const Evaluation few = sticky(0.5);
  CHECK(value_in(few, 0) > 0.0);
  CHECK(few.effort.grains < few.effort.inserted);
  CHECK_THAT(failure_in(sticky(5.0)).message, Contains("still hang in it: "));
}

TEST_CASE("a cylinder that does not fit its disc or its grains is refused", "[engine]") {
  for (const auto& [name, value] : {std::pair{"cylinder_diameter", 0.06},
                                    std::pair{"cylinder_diameter", 0.02},
                                    std::pair{"disc_diameter", 0.05},
                                    std::pair{"lift_speed", 0.0},
                                    std::pair{"fill", 0.01}}) {
    CAPTURE(name, value);
    Trial t = small_heap();
    t.experiment.settings[name] = value;
    const Evaluation evaluation = evaluate(t);
    CHECK(failure_in(evaluation).kind == FailureKind::bad_input);
    CHECK_THAT(failure_in(evaluation).message, Contains(name));
    CHECK(evaluation.effort.steps == 0);
  }
}

TEST_CASE("the heap is shown filled, lifted and at rest, smaller at the end", "[engine]") {
  std::vector<std::string> stages;
  std::vector<std::size_t> grains;
  Run run;
  run.frames = [&](const Frame& frame) {
    stages.emplace_back(frame.stage);
    grains.push_back(frame.grains.size());
  };
  evaluate(small_heap(), run);
  REQUIRE(stages == std::vector<std::string>{"filled", "lifted", "at rest"});
  CHECK(grains[2] < grains[0]);
}

TEST_CASE("more friction stands in a steeper heap", "[engine][slow]") {
  const auto angle = [](double sliding, double rolling) {
    Trial t = trial_of("heap");
    set_friction(t, sliding, rolling);
    return mean_of_seeds(t, 0, 4);
  };
  const double reference = angle(0.45, 0.05);
  CHECK(angle(0.1, 0.05) < reference - 2.0 * unit::degree.factor);
  CHECK(angle(0.45, 0.3) > reference + 2.0 * unit::degree.factor);
}
