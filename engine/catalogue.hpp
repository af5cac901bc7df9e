/// The catalogue: every effect, experiment and material property, for those who do not know the
/// types.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/effect.hpp"
#include "engine/experiment.hpp"
#include "engine/parameter_set.hpp"

namespace repose::engine {

std::span<const EffectInfo> effect_catalogue();
std::span<const ExperimentInfo> experiment_catalogue();
std::span<const FieldInfo> material_catalogue();

const EffectInfo* find_effect(std::string_view name);
const ExperimentInfo* find_experiment(std::string_view name);

/// What is known of a parameter "effect.parameter" or "material.property".
struct ParameterInfo {
  const FieldInfo* field;
  Scope scope;
};

/// Null where there is no such field. The number of materials a key must name is scope's.
const ParameterInfo* find_parameter(std::string_view field);

/// Every parameter's full name, in catalogue order.
std::span<const std::string> parameter_names();

/// How many materials a key of that scope names.
constexpr std::size_t materials_of(Scope scope) { return static_cast<std::size_t>(scope); }

/// The value of every setting of an experiment, in catalogue order: what was set, else the default
/// of the fidelity.
std::vector<double> resolved_settings(const ExperimentInfo& info, const Experiment& experiment);

}  // namespace repose::engine
