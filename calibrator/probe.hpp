/// Probe: which free parameters no measurement feels, found before anything is spent on them.
///
/// One draft run of each experiment in the middle of the cube, then, from the cheapest experiment
/// to the dearest, one with a parameter moved to a bound, all with one seed. The engine is pure: if
/// every fitted observable comes out equal to the last bit, the parameter did not touch it. Only
/// what the experiments before have not felt is asked of the next.
#pragma once

#include <cstddef>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/evaluator.hpp"

namespace repose::calibrator {

/// Indices of free parameters. A run that failed is taken for a change: it is no evidence.
std::vector<std::size_t> unfelt_parameters(const Calibration& calibration,
                                           const Evaluator& evaluator);

}  // namespace repose::calibrator
