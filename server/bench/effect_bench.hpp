/// EffectBench: what each effect does to each observable of the reference grain, from runs of the
/// virtual experiments at draft fidelity.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/catalogue.hpp"

namespace repose::server {

/// An observable without the effect and with it, SI.
struct EffectChange {
  std::string experiment, observable;
  engine::Unit unit;
  double without = 0.0, with = 0.0;  ///< means over the seeds; NaN where every run failed
  double standard_error = 0.0;       ///< of the difference; NaN where there is one seed
  std::string failure = {};          ///< why a run failed; empty: none did
};

/// An effect at its strong value.
struct EffectBench {
  std::string effect;
  std::vector<std::pair<engine::ParameterKey, double>> parameters;  ///< what is off its null
  std::vector<EffectChange> changes;
};

/// Settings under which an effect can be seen, SI: 20 % moisture for one that shows between
/// moistures only, where the reference is 12 %.
std::map<std::string, double> conditions_of(const engine::EffectInfo& effect);

/// The runs of a trial with so many seeds, in order.
using AskSeeds = std::function<std::vector<engine::Evaluation>(const engine::Trial&, int seeds)>;

/// One effect in these experiments. Without: the grain without that effect and without other forms
/// of it; with: that and the effect at its strong value.
EffectBench bench_effect(const engine::EffectInfo& effect,
                         const engine::ParameterSet& grain,
                         std::span<const engine::ExperimentInfo* const> experiments,
                         int seeds,
                         const AskSeeds& ask);

}  // namespace repose::server
