/// recheck(): whether the answer of an earlier calibration still holds: fresh replicates of its
/// best set against the measurements as they are now, before anything is searched.
///
///   passed:  |zbar_j| + s_j / (sigma_j sqrt(R)) <= 1   or   |z_j - z0_j| < 1/2,   every fitted j
///
///   zbar_j  (mean of the replicates - measured) / sigma_j   s_j  scatter of one run   R replicates
///   sigma_j  standard uncertainty of the measurement   z_j  as a Prediction's   z0_j  when it was
///   published; a measurement that is new since has none
#pragma once

#include <span>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/evaluator.hpp"
#include "calibrator/fit.hpp"
#include "calibrator/ledger.hpp"

namespace repose::calibrator {

/// An answer that was published: the question and the fit.
struct Published {
  Calibration calibration;
  Fit fit;
};

struct Recheck {
  bool passed = false;
  Fit fit;  ///< its set against the measurements now; intervals as the known runs leave them
  /// Where the emulator sees the best set now, with intervals: what is followed from night to
  /// night. Empty where too few runs are known for one.
  std::vector<FittedParameter> estimate;
  std::vector<KnownRun> runs;  ///< the replicates, for a search that goes on from them
};

/// The published set must be one of the calibration's space (has_set).
Recheck recheck(const Calibration& calibration,
                const Published& incumbent,
                const Evaluator& evaluator,
                std::span<const KnownRun> known);

}  // namespace repose::calibrator
