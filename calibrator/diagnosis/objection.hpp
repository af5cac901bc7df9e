/// Objections: why a diagnosis would be in vain, told before anything is run.
#pragma once

#include <string>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"

namespace repose::calibrator {

/// All of them; none where the question can be asked.
///
///   - fewer fitted measurements than the directions that were learnt from them, and one: whatever
///     is missing, the free parameters follow;
///   - readings of one thing that are 5 standard errors apart: no model meets both;
///   - a measurement without a standard error: it weighs everything or nothing.
std::vector<std::string> objections(const Calibration& calibration, const Fit& fit);

}  // namespace repose::calibrator
