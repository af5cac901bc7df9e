/// Laboratories have the standard apparatus. Where a study is content with drafts, what the
/// standard adds to them is learnt from pairs of runs at the best set:
///
///   d = mean of (standard - draft),   var d = (S + 4 x 2 v) / (n - 1 + 4) / n
///
///   n  pairs     S  sum of squares about the mean     v  variance of one run, by the emulator
#pragma once

#include "calibrator/diagnosis/question.hpp"
#include "calibrator/diagnosis/suite_runs.hpp"

namespace repose::calibrator {

/// Where the calibration itself learnt none.
bool wants_offset(const Calibration& calibration);

/// Adds the offset, and its uncertainty to the covariance.
void add_offset(SuiteRuns& runs, DiagnosisQuestion& question);

}  // namespace repose::calibrator
