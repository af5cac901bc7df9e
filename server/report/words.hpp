/// Words: what a fit says, in sentences. The same on the terminal and in the report.
#pragma once

#include <string>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"

namespace repose::server {

/// How good the fit is at a glance.
enum class Verdict { hit, met, missed, unfinished };

Verdict verdict(const calibrator::Calibration& calibration, const calibrator::Fit& fit);

/// "All 3 measurements are met within one standard error."
std::string headline(const calibrator::Calibration& calibration, const calibrator::Fit& fit);

/// Why the search stopped, in a sentence.
std::string stop_sentence(calibrator::StopReason stop);

/// What the data determine and what they do not, one sentence each.
std::vector<std::string> learnt_sentences(const calibrator::Calibration& calibration,
                                          const calibrator::Fit& fit);

/// What to measure next, one sentence each, best first.
std::vector<std::string> next_sentences(const calibrator::Calibration& calibration,
                                        const calibrator::Fit& fit);

}  // namespace repose::server
