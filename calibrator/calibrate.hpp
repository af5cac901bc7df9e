/// calibrate(): the loop: design, evaluate, learn, propose, confirm.
#pragma once

#include <functional>
#include <stop_token>

#include "calibrator/calibration.hpp"
#include "calibrator/evaluator.hpp"
#include "calibrator/fit.hpp"
#include "calibrator/ledger.hpp"

namespace repose::calibrator {

using ProgressObserver = std::function<void(const Progress&)>;

/// `known` runs are evidence like its own, and cost nothing. Pure: equal calibrations and equally
/// answering evaluators give equal bits, so a resumed calibration is a replay whose evaluator
/// answers from the store. Throws only what the evaluator throws.
Fit calibrate(const Calibration& calibration,
              const Evaluator& evaluator,
              std::stop_token stop = {},
              const ProgressObserver& observer = {},
              std::span<const KnownRun> known = {});

}  // namespace repose::calibrator
