#include "server/json/catalogue_schema.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "engine/catalogue.hpp"
#include "engine/unit.hpp"
#include "server/json/codec.hpp"

namespace repose::server {

using engine::FieldInfo;

namespace {

constexpr const char* dialect = "http://json-schema.org/draft-07/schema#";
constexpr const char* how_made = "Generated from the catalogue by `repose schema`: do not edit.";

/// Bounds stand in the sentence: their numbers depend on the unit that a document chooses.
std::string with_bounds(const FieldInfo& field) {
  std::string text(field.meaning);
  if (std::isnan(field.lower) || std::isnan(field.upper) || !field.choices.empty()) return text;
  text += "; " + engine::short_number(field.lower / field.unit.factor) + " to " +
          engine::short_number(field.upper / field.unit.factor);
  if (field.unit.symbol != "1") text += " " + std::string(field.unit.symbol);
  return text;
}

Json quantity(const FieldInfo& field) {
  if (!field.choices.empty()) return {{"description", field.meaning}, {"enum", field.choices}};
  return {{"description", with_bounds(field)},
          {"type", "object"},
          {"required", {"value", "unit"}},
          {"additionalProperties", false},
          {"properties",
           {{"value", {{"type", "number"}}}, {"unit", {{"enum", units_like(field.unit)}}}}}};
}

Json parameter_form(std::string_view owner, engine::Scope scope, const FieldInfo& field) {
  const std::size_t materials = engine::materials_of(scope);
  Json required{"field", "value", "unit"};
  Json properties{{"field", {{"const", std::string(owner) + "." + std::string(field.name)}}}};
  if (materials > 0) {
    required.push_back("between");
    properties["between"] = {{"type", "array"},
                             {"minItems", materials},
                             {"maxItems", materials},
                             {"items", {{"enum", engine::material_names}}}};
  }
  properties["value"] = {{"type", "number"}};
  properties["unit"] = {{"enum", units_like(field.unit)}};
  return {{"description", with_bounds(field)},
          {"type", "object"},
          {"required", std::move(required)},
          {"additionalProperties", false},
          {"properties", std::move(properties)}};
}

Json experiment_form(const engine::ExperimentInfo& experiment) {
  Json settings = Json::object();
  for (const FieldInfo& field : experiment.settings) {
    settings[std::string(field.name)] = quantity(field);
  }
  Json readings = Json::array();
  for (const engine::ObservableInfo& observable : experiment.observables) {
    readings.push_back({{"description", observable.meaning},
                        {"properties",
                         {{"observable", {{"const", observable.name}}},
                          {"unit", {{"enum", units_like(observable.unit)}}}}}});
  }
  return {{"title", experiment.title},
          {"description", experiment.summary},
          {"type", "object"},
          {"required", {"experiment", "observable", "unit"}},
          {"properties",
           {{"experiment", {{"const", experiment.name}}},
            {"settings",
             {{"type", "object"},
              {"additionalProperties", false},
              {"properties", std::move(settings)}}}}},
          {"oneOf", std::move(readings)}};
}

Json schema(const char* id, const char* title, Json forms) {
  return {{"$schema", dialect},
          {"$id", id},
          {"$comment", how_made},
          {"title", title},
          {"oneOf", std::move(forms)}};
}

}  // namespace

Json effects_schema() {
  Json forms = Json::array();
  for (const FieldInfo& field : engine::material_catalogue()) {
    forms.push_back(parameter_form(engine::Material::name, engine::Scope::material, field));
  }
  for (const engine::EffectInfo& effect : engine::effect_catalogue()) {
    for (const FieldInfo& field : effect.fields) {
      forms.push_back(parameter_form(effect.text.name, effect.scope, field));
    }
  }
  return schema("effects.schema.json", "A parameter of the model with its value", std::move(forms));
}

Json experiments_schema() {
  Json forms = Json::array();
  for (const engine::ExperimentInfo& experiment : engine::experiment_catalogue()) {
    forms.push_back(experiment_form(experiment));
  }
  return schema(
      "experiments.schema.json", "What a measurement says of its experiment", std::move(forms));
}

}  // namespace repose::server
