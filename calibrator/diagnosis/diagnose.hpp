/// diagnose(): what does a calibrated model lack?
///
///   1. the calibration's runs, and some around the best set, make an emulator of the model
///   2. probes: every suspect at 0.8 of its strong value, twice, beside eight runs without any
///   3. screen: scores of suspects, and of excuses (an apparatus is off, or off along a condition),
///      with their joint null; nothing beyond the 5 % of chance: the model is adequate
///   4. else the three best suspects are refitted with all parameters, in designs that shrink
///   5. verdict by deviance against the best excuse; pairs where no single suspect fits
///   6. explanations that are still open are asked what they expect of measurements not made yet
///
/// Laboratories have the standard apparatus. Where a study is content with drafts, what the
/// standard adds to them is learnt first, from paired runs at the best set.
///
/// Source of the rules' error rates: 7.1 of the acceptance tests, tests/calibrator/diagnosis.
#pragma once

#include <optional>
#include <stop_token>

#include "calibrator/calibration.hpp"
#include "calibrator/diagnosis/diagnosis.hpp"
#include "calibrator/evaluator.hpp"
#include "calibrator/fit.hpp"

namespace repose::calibrator {

struct DiagnosisQuestion;  // calibrator/diagnosis/question.hpp

/// What the fit's model lacks, of the catalogue's suspects and with the stated tolerances.
/// Pure, as calibrate() is: a resumed diagnosis is a replay. Nothing where it was asked to stop:
/// runs that were cut short are no evidence.
std::optional<Diagnosis> diagnose(const Calibration& calibration,
                                  const Fit& fit,
                                  const Tolerances& stated,
                                  const Evaluator& evaluator,
                                  std::stop_token stop = {},
                                  const DiagnosisObserver& observer = {});

/// The same of any question.
std::optional<Diagnosis> diagnose(const DiagnosisQuestion& question,
                                  const Evaluator& evaluator,
                                  std::stop_token stop = {},
                                  const DiagnosisObserver& observer = {});

}  // namespace repose::calibrator
