/// Draft bias: how readings at draft fidelity lie to those at standard. Measured; a draft reading
/// is worth no more than this says, and the results quote it.
#pragma once

#include <limits>
#include <string>

#include "engine/experiment.hpp"

namespace repose::server {

struct DraftBias {
  double mean = std::numeric_limits<double>::quiet_NaN();       ///< draft less standard, SI
  double deviation = std::numeric_limits<double>::quiet_NaN();  ///< of that, one run a set, SI
  int sets = 0;  ///< of parameters that were read at both; 0: not measured
};

/// What is known of an observable of an experiment.
DraftBias draft_bias(const engine::ExperimentInfo& info, const engine::ObservableInfo& observable);

/// Whether it is a draft, and some setting is left to its default of drafts: where all are given, a
/// draft is what a standard experiment is.
bool draft_is_in_force(const engine::ExperimentInfo& info, const engine::Experiment& experiment);

/// "draft reads 1.6 deg above standard (standard deviation 0.7 deg, 12 sets)"; empty where it was
/// not measured.
std::string draft_words(const engine::ExperimentInfo& info,
                        const engine::ObservableInfo& observable);

}  // namespace repose::server
