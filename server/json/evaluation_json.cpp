#include "server/json/evaluation_json.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>

#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"
#include "server/access/secret.hpp"
#include "server/json/codec.hpp"
#include "server/json/key_json.hpp"
#include "server/json/read_key.hpp"

namespace repose::server {

using engine::Effort;
using engine::Evaluation;
using engine::Failure;
using engine::Observation;
using engine::Trial;

namespace {

/// A member of Effort, whole or not.
struct EffortField {
  std::string_view name;
  std::variant<std::uint64_t Effort::*, double Effort::*> member;
};

constexpr std::array<EffortField, 10> effort_fields{{
    {"grains", &Effort::grains},
    {"inserted", &Effort::inserted},
    {"requested", &Effort::requested},
    {"steps", &Effort::steps},
    {"grain_steps", &Effort::grain_steps},
    {"rebuilds", &Effort::rebuilds},
    {"time_step", &Effort::time_step},
    {"simulated_seconds", &Effort::simulated_seconds},
    {"largest_overlap", &Effort::largest_overlap},
    {"overlap_at_rest", &Effort::overlap_at_rest},
}};

Json print_effort(const Effort& effort) {
  Json result = Json::object();
  for (const EffortField& field : effort_fields) {
    Json& entry = result[std::string(field.name)];
    if (const auto* whole = std::get_if<0>(&field.member)) {
      entry = effort.**whole;
    } else {
      entry = number_or_null(effort.*std::get<1>(field.member));
    }
  }
  return result;
}

/// A number that counts something.
std::uint64_t count_of(const Json& json) {
  if (!json.is_number_unsigned()) throw std::invalid_argument("a count is a whole number from 0");
  return json.get<std::uint64_t>();
}

Effort read_effort(const Json& json) {
  Effort effort;
  for (const EffortField& field : effort_fields) {
    const auto found = json.find(field.name);
    if (found == json.end()) continue;
    if (const auto* whole = std::get_if<0>(&field.member)) {
      effort.** whole = count_of(*found);
    } else {
      effort.*std::get<1>(field.member) = number_or_nan(*found);
    }
  }
  return effort;
}

/// Every setting of the experiment, SI; a choice by its name. An experiment that the catalogue does
/// not know keeps what it was given.
Json print_resolved(const engine::Experiment& experiment) {
  Json result = Json::object();
  const engine::ExperimentInfo* info = engine::find_experiment(experiment.name);
  if (info == nullptr) {
    for (const auto& [name, value] : experiment.settings) result[name] = number_or_null(value);
    return result;
  }
  const std::vector<double> values = engine::resolved_settings(*info, experiment);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const engine::FieldInfo& field = info->settings[i];
    result[std::string(field.name)] =
        field.choices.empty() ? number_or_null(values[i]) : print_field(values[i], field);
  }
  return result;
}

void read_settings(const Place& place,
                   const engine::ExperimentInfo& info,
                   engine::Experiment& experiment) {
  Members members(place);
  for (const engine::FieldInfo& field : info.settings) {
    const Place setting = members.optional(field.name);
    if (!setting.exists()) continue;
    std::optional<double> value;
    if (field.choices.empty()) {
      value = setting.number();
    } else {
      value = read_field(setting, field, info.name);
    }
    if (value) experiment.settings[std::string(field.name)] = *value;
  }
  members.no_others();
}

void read_parameters(const Place& place, engine::ParameterSet& parameters) {
  for (const Place& element : place.elements()) {
    Members members(element);
    const auto named = read_key(members);
    const Place value_place = members.required("value", "a number, SI");
    members.no_others();
    if (!named || !value_place.exists()) continue;
    const auto value = value_place.number();
    if (!value) continue;
    if (parameters.get(named->key)) {
      element.complain(named->text + " is there twice", "each parameter once");
    }
    parameters.set(named->key, *value);
  }
}

Failure read_failure(const Json& json) {
  const auto& kind = json.at("kind").get_ref<const std::string&>();
  const auto found = std::ranges::find(engine::failure_kind_names, std::string_view(kind));
  if (found == engine::failure_kind_names.end()) throw std::invalid_argument("unknown failure");
  return {static_cast<engine::FailureKind>(found - engine::failure_kind_names.begin()),
          json.at("message").get<std::string>(),
          number_or_nan(json.at("simulated_seconds"))};
}

engine::Outcome read_outcome(const Json& json) {
  const auto failure = json.find("failure");
  if (failure != json.end()) return read_failure(*failure);
  std::vector<Observation> observations;
  for (const Json& entry : json.at("observations")) {
    observations.push_back({entry.at("name").get<std::string>(),
                            number_or_nan(entry.at("value")),
                            entry.value("unread", std::string())});
  }
  return observations;
}

}  // namespace

std::string print_trial(const Trial& trial) {
  Json parameters = Json::array();
  for (const auto& [key, value] : trial.parameters) {
    Json entry = print_key(key);
    entry["value"] = number_or_null(value);
    parameters.push_back(std::move(entry));
  }
  const auto fidelity = static_cast<std::size_t>(trial.experiment.fidelity);
  return to_text(Json{{"experiment", trial.experiment.name},
                      {"fidelity", engine::fidelity_names.at(fidelity)},
                      {"settings", print_resolved(trial.experiment)},
                      {"parameters", std::move(parameters)},
                      {"seed", trial.seed}});
}

engine::Result<Trial, Problems> parse_trial(std::string_view text) {
  ProblemList problems;
  const auto json = parse_text(text, {}, problems);
  if (!json) return engine::Unexpected{problems.all()};
  const Place document(&*json, "", problems);
  Members members(document);
  const Place experiment = members.required("experiment", "the name of an experiment");
  const Place fidelity = members.required("fidelity", listed(engine::fidelity_names));
  const Place settings = members.optional("settings");
  const Place parameters = members.required("parameters", "a list of parameters");
  const Place seed = members.required("seed", "a whole number");
  members.no_others();

  Trial trial;
  if (experiment.exists()) {
    const auto name = experiment.text(200);
    const auto* info = name ? engine::find_experiment(*name) : nullptr;
    if (info != nullptr) {
      trial.experiment.name = *name;
      read_settings(settings, *info, trial.experiment);
    } else if (name) {
      experiment.complain("there is no such experiment", "an experiment of the catalogue");
    }
  }
  if (fidelity.exists()) {
    const auto index = fidelity.one_of(engine::fidelity_names, "fidelity");
    trial.experiment.fidelity = static_cast<engine::Fidelity>(index.value_or(0));
  }
  read_parameters(parameters, trial.parameters);
  if (seed.exists()) trial.seed = seed.seed().value_or(0);
  if (!problems.empty()) return engine::Unexpected{problems.all()};
  return trial;
}

std::string evaluation_key(const Trial& trial) {
  return digest(std::string(engine::version()) + "\n" + print_trial(trial));
}

std::string print_answer(const Evaluation& evaluation) {
  Json document;
  if (const auto* failure = std::get_if<Failure>(&evaluation.outcome)) {
    document["failure"] = {
        {"kind", engine::failure_kind_names.at(static_cast<std::size_t>(failure->kind))},
        {"message", failure->message},
        {"simulated_seconds", number_or_null(failure->simulated_seconds)}};
  } else {
    Json observations = Json::array();
    for (const Observation& seen : std::get<std::vector<Observation>>(evaluation.outcome)) {
      Json& entry = observations.emplace_back(
          Json{{"name", seen.name}, {"value", number_or_null(seen.value)}});
      if (!seen.unread.empty()) entry["unread"] = seen.unread;
    }
    document["observations"] = std::move(observations);
  }
  document["effort"] = print_effort(evaluation.effort);
  return to_text(document);
}

Evaluation parse_answer(const Trial& trial, std::string_view text) {
  Evaluation evaluation{trial, {}, {}};
  ProblemList problems;
  const auto json = parse_text(text, {}, problems);
  try {
    if (!json || !problems.empty()) throw std::invalid_argument("no JSON");
    evaluation.outcome = read_outcome(*json);
    evaluation.effort = read_effort(json->at("effort"));
  } catch (const std::exception& error) {
    constexpr std::size_t longest = 200;
    const bool silent = text.empty();
    evaluation.outcome = Failure{engine::FailureKind::crashed,
                                 silent ? "the evaluation ended without an answer"
                                        : "the evaluation gave no answer that can be read (" +
                                              std::string(error.what()) +
                                              "): " + std::string(text.substr(0, longest)),
                                 0.0};
    evaluation.effort = {};
  }
  return evaluation;
}

}  // namespace repose::server
