#include "server/json/catalogue_json.hpp"

#include <cmath>
#include <utility>

#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"
#include "server/json/codec.hpp"
#include "server/json/effect_bench_json.hpp"
#include "server/laboratory/draft_bias.hpp"
#include "server/laboratory/drawings.hpp"

namespace repose::server {

using engine::FieldInfo;

namespace {

/// A field's number in its own unit; a choice by its name; null where the field has none.
Json print_slot(double value, const FieldInfo& field) {
  if (std::isnan(value)) return nullptr;
  if (!field.choices.empty()) return print_field(value, field);
  return in_unit(value, field.unit);
}

Json print_info(const FieldInfo& field) {
  Json result{{"name", field.name}, {"meaning", field.meaning}};
  if (!field.choices.empty()) {
    result["choices"] = field.choices;
    return result;
  }
  result["unit"] = field.unit.symbol;
  result["units"] = units_like(field.unit);
  result["lower"] = print_slot(field.lower, field);
  result["upper"] = print_slot(field.upper, field);
  return result;
}

Json print_effect(const engine::EffectInfo& effect) {
  Json parameters = Json::array();
  for (const FieldInfo& field : effect.fields) {
    Json entry{{"field", std::string(effect.text.name) + "." + std::string(field.name)}};
    entry.update(print_info(field));
    entry["null"] = print_slot(field.null_value, field);
    parameters.push_back(std::move(entry));
  }
  const EffectBench* measured = measured_effect(effect.text.name);
  return {{"name", effect.text.name},
          {"title", effect.text.title},
          {"summary", effect.text.summary},
          {"citation", effect.text.citation},
          {"condition", effect.text.condition},
          {"influence", measured != nullptr ? print_changes(*measured) : Json::array()},
          {"stage", engine::stage_names.at(static_cast<std::size_t>(effect.stage))},
          {"scope", engine::scope_names.at(static_cast<std::size_t>(effect.scope))},
          {"parameters", std::move(parameters)}};
}

Json print_setting(const FieldInfo& field) {
  Json entry = print_info(field);
  const double draft = std::isnan(field.draft) ? field.null_value : field.draft;
  const double paper = std::isnan(field.paper) ? field.null_value : field.paper;
  entry["default"] = {{"draft", print_slot(draft, field)},
                      {"standard", print_slot(field.null_value, field)},
                      {"paper", print_slot(paper, field)}};
  return entry;
}

Json print_experiment(const engine::ExperimentInfo& experiment) {
  Json settings = Json::array();
  for (const FieldInfo& field : experiment.settings) settings.push_back(print_setting(field));
  Json observables = Json::array();
  for (const engine::ObservableInfo& observable : experiment.observables) {
    observables.push_back({{"name", observable.name},
                           {"meaning", observable.meaning},
                           {"unit", observable.unit.symbol},
                           {"units", units_like(observable.unit)}});
    const DraftBias draft = draft_bias(experiment, observable);
    if (draft.sets == 0) continue;
    observables.back()["draft_less_standard"] = {
        {"mean", draft.mean / observable.unit.factor},
        {"standard_deviation", draft.deviation / observable.unit.factor},
        {"sets", draft.sets}};
  }
  return {{"name", experiment.name},
          {"title", experiment.title},
          {"summary", experiment.summary},
          {"procedure", experiment.procedure},
          {"drawing", drawing_of(experiment.name)},
          {"citation", experiment.citation},
          {"settings", std::move(settings)},
          {"observables", std::move(observables)}};
}

Json print_materials() {
  Json properties = Json::array();
  for (const FieldInfo& field : engine::material_catalogue()) {
    Json entry{{"field", std::string(engine::Material::name) + "." + std::string(field.name)}};
    entry.update(print_info(field));
    properties.push_back(std::move(entry));
  }
  return {{"names", engine::material_names}, {"properties", std::move(properties)}};
}

Json print_unit(const engine::Unit& unit) {
  const engine::Dimension& dimension = unit.dimension;
  return {{"symbol", unit.symbol},
          {"si_factor", unit.factor},
          {"dimension",
           {{"length", dimension.length},
            {"mass", dimension.mass},
            {"time", dimension.time},
            {"angle", dimension.angle}}}};
}

}  // namespace

std::string print_catalogue() {
  Json effects = Json::array();
  for (const auto& effect : engine::effect_catalogue()) effects.push_back(print_effect(effect));
  Json experiments = Json::array();
  for (const auto& experiment : engine::experiment_catalogue()) {
    experiments.push_back(print_experiment(experiment));
  }
  Json units = Json::array();
  for (const engine::Unit& unit : engine::unit::all()) units.push_back(print_unit(unit));
  return to_text(Json{{"engine_version", engine::version()},
                      {"materials", print_materials()},
                      {"effects", std::move(effects)},
                      {"influences_from",
                       {{"command", measured_effects().command},
                        {"engine_version", measured_effects().engine_version}}},
                      {"experiments", std::move(experiments)},
                      {"fidelities", engine::fidelity_names},
                      {"units", std::move(units)}});
}

}  // namespace repose::server
