#include "engine/catalogue.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/effects/all.hpp"
#include "engine/experiments/all.hpp"

namespace repose::engine {

namespace {

template <class E>
inline constexpr auto field_infos = infos(E::fields);

template <class E>
std::vector<double> strong_values(const GrainScale& grains) {
  const typename E::Parameters parameters = E::strong(grains);
  std::vector<double> values;
  values.reserve(E::fields.size());
  for (const auto& field : E::fields) values.push_back(parameters.*field.member);
  return values;
}

template <class E>
constexpr EffectInfo describe() {
  static_assert(Effect<E>);
  EffectInfo info{E::text, E::stage, E::scope, field_infos<E>};
  if constexpr (StrongHook<E>) info.strong = strong_values<E>;
  return info;
}

template <class... E>
constexpr auto describe_all(const std::tuple<E...>*) {
  return std::array{describe<E>()...};
}

constexpr auto effect_infos = describe_all(static_cast<const AllEffects*>(nullptr));
constexpr auto material_infos = infos(material_fields);

struct NamedParameter {
  std::string name;
  ParameterInfo info;
};

std::vector<NamedParameter> list_parameters() {
  std::vector<NamedParameter> result;
  const auto add = [&result](std::string_view owner, Scope scope, const FieldInfo& field) {
    result.push_back({std::string(owner) + "." + std::string(field.name), {&field, scope}});
  };
  for (const FieldInfo& field : material_infos) add(Material::name, Scope::material, field);
  for (const EffectInfo& effect : effect_infos) {
    for (const FieldInfo& field : effect.fields) add(effect.text.name, effect.scope, field);
  }
  return result;
}

const std::vector<NamedParameter>& parameters() {
  static const std::vector<NamedParameter> list = list_parameters();
  return list;
}

}  // namespace

std::span<const EffectInfo> effect_catalogue() { return effect_infos; }
std::span<const ExperimentInfo> experiment_catalogue() { return all_experiments(); }
std::span<const FieldInfo> material_catalogue() { return material_infos; }

const EffectInfo* find_effect(std::string_view name) {
  const auto found = std::ranges::find(
      effect_infos, name, [](const EffectInfo& effect) { return effect.text.name; });
  return found == effect_infos.end() ? nullptr : &*found;
}

const ExperimentInfo* find_experiment(std::string_view name) {
  const auto all = all_experiments();
  const auto found = std::ranges::find(all, name, &ExperimentInfo::name);
  return found == all.end() ? nullptr : &*found;
}

const ParameterInfo* find_parameter(std::string_view field) {
  const auto found = std::ranges::find(parameters(), field, &NamedParameter::name);
  return found == parameters().end() ? nullptr : &found->info;
}

std::span<const std::string> parameter_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const NamedParameter& parameter : parameters()) result.push_back(parameter.name);
    return result;
  }();
  return names;
}

std::vector<double> resolved_settings(const ExperimentInfo& info, const Experiment& experiment) {
  std::vector<double> result;
  for (const FieldInfo& field : info.settings) {
    const auto given = experiment.settings.find(std::string(field.name));
    double value = field.null_value;
    if (experiment.fidelity == Fidelity::draft && !std::isnan(field.draft)) value = field.draft;
    if (experiment.fidelity == Fidelity::paper && !std::isnan(field.paper)) value = field.paper;
    result.push_back(given != experiment.settings.end() ? given->second : value);
  }
  return result;
}

}  // namespace repose::engine
