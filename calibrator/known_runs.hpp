/// What is asked of runs that were made for another question; known_runs() itself is the ledger's.
#pragma once

#include "calibrator/ledger.hpp"

namespace repose::calibrator {

/// Whether they tell enough of every free parameter to begin with: at least `least` of them
/// succeeded away from its commonest value.
bool know_enough(const Ledger& ledger, int least);

/// Whether a calibration's space has that parameter set, but for rounding.
bool has_set(const SearchSpace& space, const engine::ParameterSet& parameters);

}  // namespace repose::calibrator
