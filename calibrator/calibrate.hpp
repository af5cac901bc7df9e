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

/// All that may vary while the question stays the same.
struct CalibrateOptions {
  std::stop_token stop = {};
  ProgressObserver observer = {};
  std::span<const KnownRun> known = {};  ///< evidence like the search's own, that costs nothing
  Meter meter = {};                      ///< for the limits of time; empty: there are none
};

/// Pure: equal calibrations, known runs and answers (the meter's too) give equal bits, so a resumed
/// calibration is a replay whose evaluator answers from the store. Throws only what the evaluator
/// throws.
Fit calibrate(const Calibration& calibration,
              const Evaluator& evaluator,
              const CalibrateOptions& options = {});

}  // namespace repose::calibrator
