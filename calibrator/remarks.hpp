/// Remarks: what a Fit means, in sentences for people.
#pragma once

#include <string>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"
#include "calibrator/ledger.hpp"
#include "calibrator/proposal.hpp"

namespace repose::calibrator {

/// "grain-wall sliding_friction.coefficient".
std::string parameter_name(const engine::ParameterKey& key);

/// "drum dynamic_angle".
std::string measurement_name(const Measurement& measurement);

/// All that there is to say about a fit that is otherwise complete.
std::vector<std::string> remarks(const Outlook& outlook, const Fit& fit);

/// Why nothing could be learnt from the first evaluations.
std::string too_few_succeeded(const Ledger& ledger, int succeeded, int needed);

/// That the budget does not even pay for a start.
std::string budget_too_small(const Calibration& calibration, int needed);

}  // namespace repose::calibrator
