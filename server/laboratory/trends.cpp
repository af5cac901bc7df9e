#include "server/laboratory/trends.hpp"

#include <array>
#include <limits>
#include <string_view>
#include <variant>

#include "calibrator/diagnosis/suspect.hpp"
#include "engine/catalogue.hpp"
#include "server/bench/effect_bench.hpp"

namespace repose::server {

namespace {

using engine::MaterialId;
using engine::ParameterSet;

/// Values of a parameter in its own unit. What is between grains is `at_wall` of that at walls;
/// what is of a material is the wall's too where `at_wall` is not 0.
struct Sweep {
  std::string_view field;
  std::array<double, 5> values;
  double at_wall;
};

constexpr std::array sweeps{
    Sweep{"material.diameter", {5.0, 5.75, 6.496, 7.25, 8.0}, 0.0},
    Sweep{"material.density", {700.0, 950.0, 1228.0, 1600.0, 2500.0}, 0.0},
    Sweep{"material.shear_modulus", {0.6, 1.04, 2.0, 5.0, 12.0}, 1.0},
    Sweep{"material.poisson_ratio", {0.1, 0.17, 0.25, 0.33, 0.4}, 1.0},
    Sweep{"restitution.coefficient", {0.3, 0.45, 0.6, 0.75, 0.9}, 1.0},
    Sweep{"sliding_friction.coefficient", {0.2, 0.3, 0.45, 0.6, 0.8}, 2.0 / 3.0},
    Sweep{"rolling_resistance.coefficient", {0.0, 0.025, 0.05, 0.1, 0.15}, 1.0},
};

std::vector<std::vector<MaterialId>> places_of(const Sweep& sweep, engine::Scope scope) {
  using enum MaterialId;
  if (scope == engine::Scope::pair) return {{grain, grain}, {grain, wall}};
  if (sweep.at_wall != 0.0) return {{grain}, {wall}};
  return {{grain}};
}

TrendParameter swept(const Sweep& sweep, const ParameterSet& reference) {
  const engine::ParameterInfo info = *engine::find_parameter(sweep.field);
  TrendParameter parameter{std::string(sweep.field), info.field->unit, {}, {}, {}};
  for (const double value : sweep.values) {
    ParameterSet& grain = parameter.grains.emplace_back(reference);
    for (const auto& between : places_of(sweep, info.scope)) {
      const double share = between.back() == MaterialId::wall ? sweep.at_wall : 1.0;
      grain.set(engine::make_key(sweep.field, between), share * value * info.field->unit.factor);
    }
    parameter.values.push_back(value);
  }
  return parameter;
}

/// An effect in thirds of its strength: shown by its first parameter that moves.
TrendParameter grown(const calibrator::Suspect& suspect, const ParameterSet& reference) {
  constexpr std::array strengths{0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0};
  const calibrator::Lever* shown = &suspect.levers.front();
  for (const calibrator::Lever& lever : suspect.levers) {
    shown = &lever;
    if (lever.strong != lever.null_value) break;
  }
  const engine::Unit unit = engine::find_parameter(shown->key.field)->field->unit;
  TrendParameter parameter{
      shown->key.field, unit, {}, {}, conditions_of(*engine::find_effect(suspect.name))};
  for (const double strength : strengths) {
    ParameterSet& grain = parameter.grains.emplace_back(reference);
    suspect.apply(grain, strength);
    parameter.values.push_back(shown->value(reference, strength) / unit.factor);
  }
  return parameter;
}

std::vector<engine::Trial> trials_of(const ParameterSet& grain,
                                     const std::map<std::string, double>& settings,
                                     int seeds) {
  std::vector<engine::Trial> trials;
  for (const engine::ExperimentInfo& info : engine::experiment_catalogue()) {
    for (int seed = 1; seed <= seeds; ++seed) {
      trials.push_back({grain,
                        {std::string(info.name), engine::Fidelity::draft, settings},
                        static_cast<std::uint64_t>(seed)});
    }
  }
  return trials;
}

void add(Readings& readings, const engine::Evaluation& evaluation) {
  const auto* seen = std::get_if<std::vector<engine::Observation>>(&evaluation.outcome);
  const std::string& experiment = evaluation.trial.experiment.name;
  const auto observables = engine::find_experiment(experiment)->observables;
  for (std::size_t k = 0; k < observables.size(); ++k) {
    readings[experiment + "." + std::string(observables[k].name)].push_back(
        seen == nullptr ? std::numeric_limits<double>::quiet_NaN() : seen->at(k).value);
  }
}

}  // namespace

std::vector<TrendParameter> trend_parameters(const ParameterSet& reference) {
  std::vector<TrendParameter> parameters;
  calibrator::Calibration of_reference;
  of_reference.fixed = reference;
  const auto suspects = calibrator::suspects_of(of_reference, reference);
  parameters.reserve(sweeps.size() + suspects.size());
  for (const Sweep& sweep : sweeps) parameters.push_back(swept(sweep, reference));
  for (const auto& suspect : suspects) {
    const bool is_effect = engine::find_effect(suspect.name) != nullptr;
    if (is_effect && !suspect.levers.empty()) parameters.push_back(grown(suspect, reference));
  }
  return parameters;
}

Trends measure_trends(const ParameterSet& reference,
                      int reference_seeds,
                      Workers& workers,
                      const std::stop_token& stop,
                      const LaboratoryObserver& observer) {
  Trends trends;
  trends.parameters = trend_parameters(reference);
  std::vector<engine::Trial> trials = trials_of(reference, {}, reference_seeds);
  const std::size_t of_reference = trials.size();
  std::vector<std::size_t> parameter_of(of_reference);
  for (std::size_t p = 0; p < trends.parameters.size(); ++p) {
    for (const ParameterSet& grain : trends.parameters[p].grains) {
      for (engine::Trial& trial : trials_of(grain, trends.parameters[p].settings, 1)) {
        trials.push_back(std::move(trial));
        parameter_of.push_back(p);
      }
    }
  }
  const std::vector<engine::Evaluation> evaluations = workers.run(trials, stop, observer);
  trends.readings.resize(trends.parameters.size());
  for (std::size_t i = 0; i < evaluations.size(); ++i) {
    const auto* failure = std::get_if<engine::Failure>(&evaluations[i].outcome);
    if (failure != nullptr && failure->kind == engine::FailureKind::cancelled) ++trends.missing;
    add(i < of_reference ? trends.reference : trends.readings[parameter_of[i]], evaluations[i]);
  }
  return trends;
}

}  // namespace repose::server
