#include "server/bench/effect_bench.hpp"

#include <cmath>
#include <limits>

namespace repose::server {

using engine::EffectInfo;
using engine::Evaluation;
using engine::ExperimentInfo;
using engine::MaterialId;
using engine::ParameterSet;

namespace {

std::string owner_of(const engine::ParameterKey& key) {
  return key.field.substr(0, key.field.find('.'));
}

/// The grain without the effect and without other forms of it.
ParameterSet without(const ParameterSet& grain, const EffectInfo& effect) {
  ParameterSet result;
  for (const auto& [key, value] : grain) {
    const std::string owner = owner_of(key);
    const EffectInfo* other = engine::find_effect(owner);
    const bool same = owner == effect.text.name;
    const bool form =
        other != nullptr && !effect.text.family.empty() && other->text.family == effect.text.family;
    if (!same && !form) result.set(key, value);
  }
  return result;
}

/// Its grains among themselves.
engine::GrainScale scale_of(const ParameterSet& set) {
  const auto own = [&](const char* name) {
    return set.get_or({std::string("material.") + name, {MaterialId::grain}}, 0.0);
  };
  const double shear = own("shear_modulus"), poisson = own("poisson_ratio");
  return {.radius = 0.5 * own("diameter"),
          .density = own("density"),
          .elastic = {.modulus = shear / (1.0 - poisson),
                      .shear_modulus = shear / (2.0 * (2.0 - poisson))}};
}

std::vector<std::vector<MaterialId>> places_of(engine::Scope scope) {
  if (scope == engine::Scope::global) return {{}};
  if (scope == engine::Scope::material) return {{MaterialId::grain}};
  return {{MaterialId::grain, MaterialId::grain}, {MaterialId::grain, MaterialId::wall}};
}

std::vector<std::pair<engine::ParameterKey, double>> strong_parameters(const EffectInfo& effect,
                                                                       const ParameterSet& base) {
  std::vector<std::pair<engine::ParameterKey, double>> result;
  const std::vector<double> values = effect.strong(scale_of(base));
  for (std::size_t f = 0; f < values.size(); ++f) {
    if (values[f] == effect.fields[f].null_value) continue;
    const std::string name =
        std::string(effect.text.name) + "." + std::string(effect.fields[f].name);
    for (const auto& between : places_of(effect.scope)) {
      result.emplace_back(engine::make_key(name, between), values[f]);
    }
  }
  return result;
}

struct Mean {
  double value = std::numeric_limits<double>::quiet_NaN();
  double variance = std::numeric_limits<double>::quiet_NaN();  // of the mean
  std::string failure;
};

Mean mean_of(const std::vector<Evaluation>& runs, std::size_t observable) {
  std::vector<double> values;
  Mean mean;
  for (const Evaluation& run : runs) {
    if (const auto* failure = std::get_if<engine::Failure>(&run.outcome)) {
      mean.failure = failure->message;
    } else {
      const auto& seen = std::get<std::vector<engine::Observation>>(run.outcome)[observable];
      if (seen.unread.empty()) {
        values.push_back(seen.value);
      } else {
        mean.failure = seen.unread;
      }
    }
  }
  if (values.empty()) return mean;
  const auto n = static_cast<double>(values.size());
  mean.value = 0.0;
  for (const double value : values) mean.value += value / n;
  if (values.size() < 2) return mean;
  mean.variance = 0.0;
  for (const double value : values) {
    mean.variance += (value - mean.value) * (value - mean.value) / (n * (n - 1.0));
  }
  return mean;
}

}  // namespace

std::map<std::string, double> conditions_of(const EffectInfo& effect) {
  if (effect.text.condition != "moisture") return {};
  return {{"moisture", 0.20}};
}

EffectBench bench_effect(const EffectInfo& effect,
                         const ParameterSet& grain,
                         std::span<const ExperimentInfo* const> experiments,
                         int seeds,
                         const AskSeeds& ask) {
  const ParameterSet base = without(grain, effect);
  EffectBench bench{std::string(effect.text.name), strong_parameters(effect, base), {}};
  ParameterSet strong = base;
  for (const auto& [key, value] : bench.parameters) strong.set(key, value);
  for (const ExperimentInfo* experiment : experiments) {
    const engine::Experiment what{
        std::string(experiment->name), engine::Fidelity::draft, conditions_of(effect)};
    const auto runs_without = ask({base, what, 1}, seeds),
               runs_with = ask({strong, what, 1}, seeds);
    for (std::size_t i = 0; i < experiment->observables.size(); ++i) {
      const Mean before = mean_of(runs_without, i), after = mean_of(runs_with, i);
      bench.changes.push_back({what.name,
                               std::string(experiment->observables[i].name),
                               experiment->observables[i].unit,
                               before.value,
                               after.value,
                               std::sqrt(before.variance + after.variance),
                               after.failure.empty() ? before.failure : after.failure});
    }
  }
  return bench;
}

}  // namespace repose::server
