#include "server/bench/effect_bench.hpp"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "server/cli/catalogue_text.hpp"
#include "server/cli/reference_grain.hpp"
#include "server/json/catalogue_json.hpp"
#include "server/json/effect_bench_json.hpp"

using namespace repose;
using namespace repose::server;
using engine::MaterialId;

namespace {

const engine::ParameterKey rolling{"rolling_resistance.coefficient",
                                   {MaterialId::grain, MaterialId::grain}};

/// Answers with what the rolling coefficient is, a little more for every seed; keeps the trials.
struct Ask {
  std::vector<engine::Trial> trials;

  std::vector<engine::Evaluation> operator()(const engine::Trial& trial, int seeds) {
    trials.push_back(trial);
    std::vector<engine::Evaluation> runs;
    for (int seed = 0; seed < seeds; ++seed) {
      const double value = trial.parameters.get_or(rolling, 0.0) + 0.01 * seed;
      runs.push_back({trial, std::vector<engine::Observation>{{"restitution", value}}, {}});
    }
    return runs;
  }
};

EffectBench bench(const char* effect, Ask& ask, int seeds = 2) {
  const engine::ExperimentInfo* drop = engine::find_experiment("drop");
  return bench_effect(
      *engine::find_effect(effect), reference_grain(), {&drop, 1}, seeds, std::ref(ask));
}

}  // namespace

TEST_CASE("an effect is benched against the grain without it, with what the seeds scatter",
          "[server]") {
  Ask ask;
  const EffectBench result = bench("rolling_resistance", ask);
  REQUIRE(ask.trials.size() == 2);
  CHECK_FALSE(ask.trials[0].parameters.get(rolling));  // the reference grain has 0.05
  CHECK(ask.trials[1].parameters.get(rolling) == 0.2);
  REQUIRE(result.changes.size() == 1);
  CHECK(result.changes[0].with - result.changes[0].without == Approx(0.2));
  // Two seeds 0.01 apart: each mean has a standard error of 0.005.
  CHECK(result.changes[0].standard_error == Approx(0.005 * std::sqrt(2.0)));
  CHECK(std::isnan(bench("rolling_resistance", ask, 1).changes[0].standard_error));
}

TEST_CASE("effects of moisture are benched in the wet, both without and with", "[server]") {
  Ask ask;
  bench("moisture_friction", ask);
  REQUIRE(ask.trials.size() == 2);
  for (const engine::Trial& trial : ask.trials) {
    CHECK(trial.experiment.settings.at("moisture") == 0.20);
  }
}

TEST_CASE("a run that fails is told, not averaged", "[server]") {
  const engine::ExperimentInfo* drop = engine::find_experiment("drop");
  const auto fail = [](const engine::Trial& trial, int) {
    const engine::Failure failure{engine::FailureKind::not_observed, "no rebound", 0.0};
    return std::vector<engine::Evaluation>{{trial, failure, {}}};
  };
  const EffectBench result =
      bench_effect(*engine::find_effect("air_drag"), reference_grain(), {&drop, 1}, 1, fail);
  CHECK(result.changes[0].failure == "no rebound");
  CHECK(std::isnan(result.changes[0].with));
}

TEST_CASE("what the catalogue quotes was measured on effects and experiments that there are",
          "[server]") {
  for (const EffectBench& effect : measured_effects().effects) {
    CAPTURE(effect.effect);
    CHECK(engine::find_effect(effect.effect) != nullptr);
    CHECK_FALSE(effect.parameters.empty());
    for (const EffectChange& change : effect.changes) {
      CHECK(engine::find_experiment(change.experiment) != nullptr);
    }
  }
}

TEST_CASE("the catalogue quotes the runs with their command", "[server]") {
  const auto catalogue = nlohmann::json::parse(print_catalogue());
  CHECK(catalogue["influences_from"]["command"].get<std::string>().find("repose bench effects") ==
        0);
  for (const auto& effect : catalogue["effects"]) {
    const EffectBench* measured = measured_effect(effect["name"].get<std::string>());
    CHECK(effect["influence"].size() == (measured == nullptr ? 0 : measured->changes.size()));
  }
  if (!measured_effects().effects.empty()) {
    CHECK(catalogue_markdown().find(measured_effects().command) != std::string::npos);
  }
}

TEST_CASE("what the bench prints can be read as the data of the catalogue", "[server]") {
  Ask ask;
  const std::vector<EffectBench> effects{bench("rolling_resistance", ask)};
  const auto json = nlohmann::json::parse(print_effect_bench(effects, 2));
  CHECK(json["command"] == "repose bench effects --seeds 2 --json");
  CHECK(json["effects"][0]["parameters"].size() == 2);  // both pairs
  CHECK(json["effects"][0]["changes"][0]["with"].get<double>() ==
        Approx(effects[0].changes[0].with));
}
