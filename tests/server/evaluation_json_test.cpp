#include "server/json/evaluation_json.hpp"

#include <cmath>
#include <limits>
#include <variant>

#include <catch2/catch.hpp>

#include "engine/catalogue.hpp"

namespace {

using repose::server::evaluation_key;
using repose::server::parse_answer;
using repose::server::parse_trial;
using repose::server::print_answer;
using repose::server::print_trial;
namespace engine = repose::engine;
using engine::MaterialId;

engine::Trial kettle() {
  engine::Trial trial;
  trial.experiment = {"kettle", engine::Fidelity::draft, {{"height", 0.1 + 0.2}}};
  trial.parameters.set(
      engine::make_key("restitution.coefficient", {MaterialId::wall, MaterialId::grain}),
      1.0 / 3.0);
  trial.parameters.set(engine::make_key("material.density", {MaterialId::grain}), 1228.0);
  trial.seed = std::numeric_limits<std::uint64_t>::max();
  return trial;
}

engine::Failure failure_of(const engine::Evaluation& evaluation) {
  return std::get<engine::Failure>(evaluation.outcome);
}

}  // namespace

TEST_CASE("a question is one line that reads back to the same line", "[server]") {
  const std::string line = print_trial(kettle());
  CHECK(line.find('\n') == std::string::npos);
  const auto again = parse_trial(line);
  REQUIRE(again);
  CHECK(print_trial(*again) == line);
  CHECK(again->parameters == kettle().parameters);
  CHECK(again->seed == kettle().seed);
}

TEST_CASE("a setting at its default asks the same question as none", "[server]") {
  engine::Trial trial = kettle();
  const engine::ExperimentInfo& info = *engine::find_experiment("kettle");
  const auto resolved = engine::resolved_settings(info, trial.experiment);
  for (std::size_t i = 0; i < resolved.size(); ++i) {
    trial.experiment.settings[std::string(info.settings[i].name)] = resolved[i];
  }
  CHECK(evaluation_key(trial) == evaluation_key(kettle()));
}

TEST_CASE("whatever may change the answer changes the key", "[server]") {
  const std::string key = evaluation_key(kettle());
  CHECK(key.size() == 64);
  engine::Trial other = kettle();
  other.seed = 1;
  CHECK(evaluation_key(other) != key);
  other = kettle();
  other.experiment.settings["height"] = 0.3;  // 0.1 + 0.2 is its neighbour
  CHECK(evaluation_key(other) != key);
  other = kettle();
  other.experiment.fidelity = engine::Fidelity::standard;
  CHECK(evaluation_key(other) != key);
  other = kettle();
  other.parameters.set(engine::make_key("material.density", {MaterialId::grain}), 1229.0);
  CHECK(evaluation_key(other) != key);
}

TEST_CASE("a question names all of its problems", "[server]") {
  const auto result = parse_trial(
      R"({"experiment":"drop","fidelity":"rough","settings":{"hight":1},"seed":-1,
          "parameters":[{"field":"a.b","value":1},{"field":"material.density","between":["grain"],"value":"x"}]})");
  REQUIRE(!result);
  CHECK(result.error().size() == 5);
  CHECK(!parse_trial("[]"));
  CHECK(!parse_trial("{}"));
  CHECK(!parse_trial(""));
}

TEST_CASE("an answer reads back to the last bit", "[server]") {
  engine::Evaluation evaluation{kettle(), {}, {}};
  evaluation.outcome = std::vector<engine::Observation>{
      {"bulk_density", 0.1 + 0.2}, {"x", 5e-324}, {"y", -0.0}, {"z", 1.7976931348623157e308}};
  evaluation.effort = {
      4000, 4100, 4200, 1'000'000, 18446744073709551615U, 99, 1e-5, 3.25, 0.0123, 0.004};
  const std::string text = print_answer(evaluation);
  const engine::Evaluation again = parse_answer(kettle(), text);
  const auto& seen = std::get<std::vector<engine::Observation>>(again.outcome);
  REQUIRE(seen.size() == 4);
  CHECK(seen[0].value == 0.1 + 0.2);
  CHECK(seen[1].value == 5e-324);
  CHECK(std::signbit(seen[2].value));
  CHECK(again.effort.grain_steps == 18446744073709551615U);
  CHECK(again.effort.largest_overlap == 0.0123);
  CHECK(again.effort.overlap_at_rest == 0.004);
  CHECK(again.trial == kettle());
  CHECK(print_answer(again) == text);
}

TEST_CASE("an observation that is no number is null and reads back as none", "[server]") {
  engine::Evaluation evaluation{kettle(), {}, {}};
  evaluation.outcome = std::vector<engine::Observation>{{"a", std::nan("")}, {"b", INFINITY}};
  const std::string text = print_answer(evaluation);
  CHECK(text.find(R"({"name":"a","value":null},{"name":"b","value":null})") != std::string::npos);
  const engine::Evaluation again = parse_answer(kettle(), text);
  CHECK(std::isnan(std::get<std::vector<engine::Observation>>(again.outcome).at(0).value));
}

TEST_CASE("why an observable was not read reads back with it", "[server]") {
  engine::Evaluation evaluation{kettle(), {}, {}};
  evaluation.outcome =
      std::vector<engine::Observation>{{"rate", 1.5}, {"angle", std::nan(""), "no slope stands"}};
  const std::string text = print_answer(evaluation);
  const engine::Evaluation again = parse_answer(kettle(), text);
  const auto& seen = std::get<std::vector<engine::Observation>>(again.outcome);
  CHECK(seen.at(0).unread.empty());
  CHECK(std::isnan(seen.at(1).value));
  CHECK(seen.at(1).unread == "no slope stands");
  CHECK(print_answer(again) == text);
}

TEST_CASE("every failure reads back with its message and its time", "[server]") {
  for (std::size_t i = 0; i < engine::failure_kind_names.size(); ++i) {
    engine::Evaluation evaluation{kettle(), {}, {}};
    evaluation.outcome =
        engine::Failure{static_cast<engine::FailureKind>(i), "\"why\"\n\xff", 1.0 / 3.0};
    const engine::Failure again = failure_of(parse_answer(kettle(), print_answer(evaluation)));
    CHECK(static_cast<std::size_t>(again.kind) == i);
    CHECK(again.simulated_seconds == 1.0 / 3.0);
  }
}

TEST_CASE("a text that is no answer is an evaluation that crashed", "[server]") {
  for (const char* text : {"",
                           "{",
                           "[]",
                           "{}",
                           "null",
                           R"({"observations":1,"effort":{}})",
                           R"({"observations":[]})",
                           R"({"failure":{"kind":"bored"},"effort":{}})",
                           R"({"observations":[{"name":"a","value":"b"}],"effort":{}})",
                           R"({"observations":[],"effort":{"grains":-1.5e9}})",
                           R"({"observations":[],"effort":{"grains":1e30}})",
                           R"({"observations":[],"effort":{"grains":-1}})",
                           R"({"observations":[],"effort":{"steps":"many"}})",
                           "Segmentation fault"}) {
    INFO(text);
    CHECK(failure_of(parse_answer(kettle(), text)).kind == engine::FailureKind::crashed);
  }
}
