#include "engine/amendment.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;

TEST_CASE("every experiment can be done at a moisture", "[engine]") {
  for (const ExperimentInfo& info : experiment_catalogue()) {
    CAPTURE(info.name);
    CHECK(std::ranges::count(info.settings, "moisture", &FieldInfo::name) == 1);
  }
}

TEST_CASE("an effect shows along a condition that there is", "[engine]") {
  for (const EffectInfo& effect : effect_catalogue()) {
    CAPTURE(effect.text.name);
    const bool amends = effect.stage == Stage::amendment;
    CHECK(amends == !effect.text.condition.empty());
    if (!amends) continue;
    CHECK(std::ranges::any_of(condition_fields, [&](const auto& field) {
      return field.info.name == effect.text.condition;
    }));
  }
}

TEST_CASE("a set without effects of moisture is the same at every moisture", "[engine]") {
  const ParameterSet set = repose::tests::reference_grain();
  CHECK(amended(set, {.moisture = 0.3}) == set);
}

TEST_CASE("what a condition makes of a parameter must lie in its bounds too", "[engine]") {
  ParameterSet set = repose::tests::reference_grain();
  set.set({"moisture_softening.rate", {MaterialId::grain}}, 40.0);
  const Evaluation evaluation = evaluate(
      {.parameters = set, .experiment = {.name = "drop", .settings = {{"moisture", 0.5}}}});
  const Failure& failure = std::get<Failure>(evaluation.outcome);
  CHECK(failure.kind == FailureKind::bad_input);
  CHECK(failure.message.find("material.shear_modulus:grain") != std::string::npos);
}
