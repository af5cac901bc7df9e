// What holds for every virtual experiment, and what each must give.
#include <cmath>
#include <set>

#include <catch2/catch.hpp>

#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"
#include "tests/support/trials.hpp"

using namespace repose::engine;

namespace {

Trial trial(std::string_view experiment, Fidelity fidelity = Fidelity::draft) {
  return repose::tests::trial_of(experiment, fidelity);
}

Trial small_trial(std::string_view experiment) {
  Trial result = trial(experiment);
  result.experiment.settings = repose::tests::small_settings(experiment);
  return result;
}

const std::vector<Observation>& observations(const Evaluation& evaluation) {
  if (const auto* failure = std::get_if<Failure>(&evaluation.outcome)) FAIL(failure->message);
  return std::get<std::vector<Observation>>(evaluation.outcome);
}

FailureKind failure_of(const Trial& t, const Run& run = {}) {
  const Evaluation evaluation = evaluate(t, run);
  const auto* failure = std::get_if<Failure>(&evaluation.outcome);
  REQUIRE(failure != nullptr);
  INFO(failure->message);
  CHECK(failure->message.size() > 10);
  return failure->kind;
}

}  // namespace

TEST_CASE("every experiment ends and gives its observables in order", "[engine]") {
  for (const ExperimentInfo& info : experiment_catalogue()) {
    CAPTURE(info.name);
    const Evaluation evaluation = evaluate(small_trial(info.name));
    const auto& seen = observations(evaluation);
    REQUIRE(seen.size() == info.observables.size());
    for (std::size_t i = 0; i < seen.size(); ++i) {
      CHECK(seen[i].name == info.observables[i].name);
      CHECK(std::isfinite(seen[i].value));
    }
    CHECK(evaluation.effort.inserted > 0);
    CHECK(evaluation.effort.requested >= evaluation.effort.inserted);
    CHECK(evaluation.effort.grain_steps > 0);
  }
}

TEST_CASE("the same seed gives the same bits, another seed another bed", "[engine][slow]") {
  for (const ExperimentInfo& info : experiment_catalogue()) {
    CAPTURE(info.name);
    const Trial one = small_trial(info.name);
    Trial two = one;
    two.seed = 2;
    const double a = observations(evaluate(one))[0].value;
    CHECK(observations(evaluate(one))[0].value == a);
    if (info.name != "drop") CHECK(observations(evaluate(two))[0].value != a);
  }
}

TEST_CASE("a run that is asked to stop stops at once", "[engine]") {
  std::stop_source source;
  source.request_stop();
  for (const ExperimentInfo& info : experiment_catalogue()) {
    CAPTURE(info.name);
    CHECK(failure_of(trial(info.name, Fidelity::standard), {.stop = source.get_token()}) ==
          FailureKind::cancelled);
  }
}

TEST_CASE("every experiment and setting is documented, its default within its bounds", "[engine]") {
  for (const ExperimentInfo& info : experiment_catalogue()) {
    CAPTURE(info.name);
    CHECK_FALSE(info.summary.empty());
    CHECK_FALSE(info.procedure.empty());
    CHECK_FALSE(info.citation.empty());
    for (const FieldInfo& field : info.settings) {
      CAPTURE(field.name);
      CHECK_FALSE(field.meaning.empty());
      for (const double value : {field.null_value, field.draft, field.paper}) {
        if (std::isnan(value)) continue;
        CHECK(field.lower <= value);
        CHECK(value <= field.upper);
      }
      CHECK(std::isfinite(field.null_value));
    }
  }
}

TEST_CASE("a question that cannot be run is refused with the reason", "[engine]") {
  Trial t = trial("drop");
  t.experiment.name = "dropp";
  CHECK(failure_of(t) == FailureKind::bad_input);
  t = trial("drop");
  t.experiment.settings["hight"] = 0.1;
  CHECK(failure_of(t) == FailureKind::bad_input);
  t = trial("drop");
  t.experiment.settings["height"] = -0.1;
  CHECK(failure_of(t) == FailureKind::bad_input);
  t = trial("drop");
  t.parameters.set({"restitution.coefficient", {MaterialId::grain, MaterialId::wall}}, 1.5);
  CHECK(failure_of(t) == FailureKind::bad_input);
  t = trial("drop");
  t.parameters.set({"restitution.coefficient", {MaterialId::grain}}, 0.5);
  CHECK(failure_of(t) == FailureKind::bad_input);
  t = trial("drop");
  t.parameters.erase({"material.density", {MaterialId::grain}});
  CHECK(failure_of(t) == FailureKind::bad_input);
  t = trial("drop");
  t.parameters.set({"sliding.coefficient", {MaterialId::grain, MaterialId::wall}}, 0.5);
  CHECK(failure_of(t) == FailureKind::bad_input);
  t = trial("kettle");
  t.experiment.settings["diameter"] = 0.02;  // three grains wide
  CHECK(failure_of(t) == FailureKind::bad_input);
}

TEST_CASE("a time step that is not stable is refused", "[engine]") {
  for (const std::string_view name : {"kettle", "tilting_box", "heap", "draw_down"}) {
    CAPTURE(name);
    Trial t = trial(name);
    t.experiment.settings["time_step"] = 0.8;
    CHECK(failure_of(t) == FailureKind::time_step_too_large);
  }
}

TEST_CASE("the drop test gives back the restitution asked for", "[engine]") {
  for (const double e : {0.3, 0.6, 0.9}) {
    for (const double shear_modulus : {1.04e6, 41.7e6}) {
      CAPTURE(e, shear_modulus);
      Trial t = trial("drop", Fidelity::standard);
      t.parameters.set({"material.shear_modulus", {MaterialId::grain}}, shear_modulus);
      t.parameters.set({"restitution.coefficient", {MaterialId::grain, MaterialId::wall}}, e);
      CHECK(observations(evaluate(t))[0].value == Approx(e).margin(0.005));
    }
  }
}

TEST_CASE("a grain that falls through the floor is told, not looked for", "[engine]") {
  Trial t = trial("drop");
  t.parameters.set({"material.shear_modulus", {MaterialId::grain}}, 1e4);
  t.experiment.settings["height"] = 5.0;
  CHECK(failure_of(t) == FailureKind::unstable);
}

TEST_CASE("an opening too narrow for its friction ends as a failure, not as a number", "[engine]") {
  Trial t = small_trial("kettle");
  t.experiment.settings["source"] = 0.0;
  for (const MaterialId partner : {MaterialId::grain, MaterialId::wall}) {
    t.parameters.set({"sliding_friction.coefficient", {MaterialId::grain, partner}}, 1.5);
    t.parameters.set({"elastic_rolling_resistance.coefficient", {MaterialId::grain, partner}}, 0.8);
  }
  CHECK(failure_of(t) == FailureKind::did_not_fill);
}

TEST_CASE("frames show the stages of the protocol with all grains", "[engine]") {
  std::set<std::string> stages;
  std::size_t grains = 0;
  Run run;
  run.frames = [&](const Frame& frame) {
    stages.insert(std::string(frame.stage));
    grains = std::max(grains, frame.grains.size());
    CHECK_FALSE(frame.walls.empty());
  };
  const Evaluation evaluation = evaluate(small_trial("tilting_box"), run);
  CHECK(stages == std::set<std::string>{"filled", "sliding"});
  CHECK(grains == evaluation.effort.grains);
}

TEST_CASE("when a bed counts as moving is the laboratory's choice", "[engine]") {
  const auto angles = [](double slide, double onset_speed) {
    Trial t = small_trial("tilting_box");
    t.experiment.settings["slide"] = slide;
    t.experiment.settings["onset_speed"] = onset_speed;
    const Evaluation evaluation = evaluate(t);
    return std::pair{observations(evaluation)[0].value, observations(evaluation)[1].value};
  };
  const auto [half, slow] = angles(0.5, 0.01);
  const auto [whole, fast] = angles(1.0, 0.02);
  CHECK(whole > half);
  CHECK(fast > slow);
  // A layer that slides freely down a frictionless slope turning at `rate` has gone no further
  // than g rate t^3 / 6, so that the angle of a whole diameter is at most 2^(1/3) of that of half.
  CHECK(whole < std::cbrt(2.0) * half);
}

TEST_CASE("frames change nothing in the answer", "[engine]") {
  Run run;
  run.frames = [](const Frame&) {};
  run.frame_interval = 0.01;
  const Trial t = small_trial("kettle");
  CHECK(observations(evaluate(t, run))[0].value == observations(evaluate(t))[0].value);
}

TEST_CASE("the kettle counts grains whose centre, or whose whole, is below the rim", "[engine]") {
  Trial t = small_trial("kettle");
  const double height = t.experiment.settings.at("height");
  int centres = 0, wholes = 0;
  Run run;
  run.frames = [&](const Frame& frame) {
    for (const FrameGrain& grain : frame.grains) {
      if (frame.stage != "filled" || grain.centre.z < 0.0) continue;
      if (grain.centre.z < height) ++centres;
      if (grain.centre.z + grain.radius < height) ++wholes;
    }
  };
  const double by_centre = observations(evaluate(t, run))[0].value;
  t.experiment.settings["rim"] = 1.0;
  const double by_whole = observations(evaluate(t))[0].value;
  CHECK(wholes < centres);
  CHECK(by_whole / by_centre == Approx(static_cast<double>(wholes) / centres));
}

TEST_CASE("harder friction stands steeper and packs looser", "[engine][slow]") {
  const auto measure = [](std::string_view name, double friction) {
    double sum = 0.0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      Trial t = trial(name);
      t.seed = seed;
      t.parameters.set(
          make_key("sliding_friction.coefficient", {MaterialId::grain, MaterialId::grain}),
          friction);
      sum += observations(evaluate(t))[0].value / 3;
    }
    return sum;
  };
  CHECK(measure("tilting_box", 0.8) > measure("tilting_box", 0.2));
  CHECK(measure("kettle", 0.8) < measure("kettle", 0.2));
}
