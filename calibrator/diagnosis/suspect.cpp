#include "calibrator/diagnosis/suspect.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "calibrator/comparison.hpp"
#include "engine/catalogue.hpp"

namespace repose::calibrator {
namespace {

using engine::EffectInfo;
using engine::MaterialId;
using engine::ParameterKey;
using engine::ParameterSet;

std::string_view owner_of(const ParameterKey& key) {
  return std::string_view(key.field).substr(0, key.field.find('.'));
}

/// Whether no strength of the effect moves the field: it is data, as the moisture at which a model's
/// friction is meant.
bool is_data(const engine::FieldInfo& field, double strong) { return strong == field.null_value; }

/// Whether the field may lie beyond its null on the side away from the strong value, too.
bool goes_either_way(const engine::FieldInfo& field, double strong) {
  return strong > field.null_value ? field.lower < field.null_value
                                   : field.upper > field.null_value;
}

bool is_data(const ParameterKey& key, const engine::GrainScale& grains) {
  const EffectInfo* effect = engine::find_effect(owner_of(key));
  if (effect == nullptr || effect->strong == nullptr) return false;
  const std::vector<double> strong = effect->strong(grains);
  for (std::size_t f = 0; f < effect->fields.size(); ++f) {
    const engine::FieldInfo& field = effect->fields[f];
    if (key.field.substr(key.field.find('.') + 1) == field.name) return is_data(field, strong[f]);
  }
  return false;
}

/// Effects that the model has: a parameter that is free, tied, or fixed off its null.
std::set<std::string_view> effects_in_use(const Calibration& calibration,
                                          const engine::GrainScale& grains) {
  std::set<std::string_view> names;
  for (const auto& [key, value] : calibration.fixed) {
    const engine::ParameterInfo* info = engine::find_parameter(key.field);
    const bool on = info != nullptr && value != info->field->null_value;
    if (on && !is_data(key, grains)) names.insert(owner_of(key));
  }
  for (const FreeParameter& free : calibration.free) names.insert(owner_of(free.key));
  for (const Tie& tie : calibration.tied) names.insert(owner_of(tie.key));
  return names;
}

double material(const ParameterSet& set, std::string_view property, double otherwise) {
  return set.get_or(engine::make_key("material." + std::string(property), {MaterialId::grain}),
                    otherwise);
}

engine::GrainScale scale_of(const ParameterSet& best) {
  const double shear = material(best, "shear_modulus", 1e6);
  const double poisson = material(best, "poisson_ratio", 0.25);
  const double young = 2.0 * shear * (1.0 + poisson);
  return {.radius = 0.5 * material(best, "diameter", 6e-3),
          .density = material(best, "density", 1200.0),
          .elastic = {.modulus = young / (2.0 * (1.0 - poisson * poisson)),
                      .shear_modulus = shear / (2.0 * (2.0 - poisson))}};
}

/// The materials a parameter is set for: every grain contact there is.
std::vector<std::vector<MaterialId>> places_of(engine::Scope scope) {
  if (scope == engine::Scope::global) return {{}};
  if (scope == engine::Scope::material) return {{MaterialId::grain}};
  return {{MaterialId::grain, MaterialId::grain}, {MaterialId::grain, MaterialId::wall}};
}

/// `stated`: what the study fixes; data stated there are kept.
Suspect suspect_of(const EffectInfo& effect,
                   const ParameterSet& stated,
                   const engine::GrainScale& grains) {
  Suspect suspect{std::string(effect.text.name), std::string(effect.text.title), {}};
  const std::vector<double> strong = effect.strong(grains);
  for (std::size_t f = 0; f < effect.fields.size(); ++f) {
    const engine::FieldInfo& field = effect.fields[f];
    const bool data = is_data(field, strong[f]);
    if (!data) suspect.two_sided |= goes_either_way(field, strong[f]);
    for (const auto& between : places_of(effect.scope)) {
      const auto key = engine::make_key(suspect.name + "." + std::string(field.name), between);
      if (data && stated.get(key)) continue;
      suspect.levers.push_back({.key = key,
                                .null_value = field.null_value,
                                .strong = strong[f],
                                .lower = field.lower,
                                .upper = field.upper,
                                .whole = field.whole});
    }
  }
  return suspect;
}

/// Why an effect that shows along a condition cannot show in these measurements; empty: it can.
std::string lacks(const Calibration& calibration, const EffectInfo& effect) {
  const std::string condition(effect.text.condition);
  if (condition.empty()) return {};
  std::set<double> values;
  for (const Measurement& measurement : calibration.measurements) {
    values.insert(setting_of(measurement, condition));
  }
  if (values.size() > 1) return {};
  return "every measurement is at the same " + condition + "; add some at another";
}

/// Walls whose friction follows the grains', or is set equal to it, may have one of their own.
void add_wall_friction(const Calibration& calibration,
                       const ParameterSet& best,
                       std::vector<Suspect>& suspects) {
  const char* const name = "sliding_friction.coefficient";
  const ParameterKey wall = engine::make_key(name, {MaterialId::grain, MaterialId::wall});
  const auto own = best.get(wall);
  const auto grains = best.get(engine::make_key(name, {MaterialId::grain, MaterialId::grain}));
  const bool free =
      std::ranges::find(calibration.free, wall, &FreeParameter::key) != calibration.free.end();
  const bool tied = std::ranges::find(calibration.tied, wall, &Tie::key) != calibration.tied.end();
  const bool equal = own && grains && *own == *grains && *own > 0.0;
  if (free || !(tied || equal)) return;
  suspects.push_back(
      {.name = std::string(own_wall_friction),
       .title = "A wall friction of its own",
       .levers = {{.key = wall, .strong = 0.5, .lower = 0.0, .upper = 2.0, .relative = true}},
       .two_sided = true});
}

}  // namespace

double Lever::value(const ParameterSet& parameters, double strength) const {
  const double wanted = relative ? parameters.get_or(key, 0.0) * (1.0 + strong * strength)
                                 : null_value + strength * (strong - null_value);
  return std::clamp(whole ? std::round(wanted) : wanted, lower, upper);
}

void Suspect::apply(ParameterSet& parameters, double strength) const {
  if (strength == 0.0) return;
  for (const Lever& lever : levers) {
    parameters.set(lever.key, lever.value(parameters, strength));
  }
}

double Suspect::snapped(double strength) const {
  for (const Lever& lever : levers) {
    if (lever.whole) {
      return (lever.value({}, strength) - lever.null_value) / (lever.strong - lever.null_value);
    }
  }
  return strength;
}

void extend(const Suspect& suspect, const ParameterSet& best, Calibration& calibration) {
  for (const Lever& lever : suspect.levers) {
    std::erase_if(calibration.tied, [&](const Tie& tie) { return tie.key == lever.key; });
    calibration.fixed.erase(lever.key);
    const engine::ParameterInfo* info = engine::find_parameter(lever.key.field);
    const engine::Unit unit = info != nullptr ? info->field->unit : engine::Unit{};
    const double none = lever.relative      ? lever.value(best, -1.0)
                        : suspect.two_sided ? lever.value(best, -largest_strength)
                                            : lever.null_value;
    const double most = lever.value(best, lever.whole ? 1.0 : largest_strength);
    // What no strength moves belongs to the effect, but not to the search.
    if (none == most) {
      calibration.fixed.set(lever.key, none);
      continue;
    }
    const auto leader = std::ranges::find(calibration.free,
                                          lever.key.field,
                                          [](const FreeParameter& free) { return free.key.field; });
    if (leader != calibration.free.end() && !lever.relative) {
      calibration.tied.push_back({lever.key, leader->key, 1.0});
      continue;
    }
    calibration.free.push_back(
        {lever.key, std::min(none, most), std::max(none, most), Scale::linear, unit});
  }
}

std::vector<Suspect> suspects_of(const Calibration& calibration, const ParameterSet& best) {
  const engine::GrainScale grains = scale_of(best);
  const std::set<std::string_view> in_use = effects_in_use(calibration, grains);
  std::set<std::string_view> families;
  for (const std::string_view name : in_use) {
    const EffectInfo* effect = engine::find_effect(name);
    if (effect != nullptr && !effect->text.family.empty()) families.insert(effect->text.family);
  }
  const auto named = [&](std::string_view name) {
    return calibration.suspects.empty() ||
           std::ranges::find(calibration.suspects, name) != calibration.suspects.end();
  };
  std::vector<Suspect> suspects;
  for (const EffectInfo& effect : engine::effect_catalogue()) {
    if (effect.strong == nullptr || in_use.contains(effect.text.name) || !named(effect.text.name)) {
      continue;
    }
    if (families.contains(effect.text.family)) continue;  // the model has another form of it
    suspects.push_back(suspect_of(effect, calibration.fixed, grains));
    suspects.back().objection = lacks(calibration, effect);
  }
  if (named(own_wall_friction)) add_wall_friction(calibration, best, suspects);
  return suspects;
}

}  // namespace repose::calibrator
