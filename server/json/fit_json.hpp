/// Fit <-> document (schemas/fit.schema.json): numbers in the units of the calibration's author.
#pragma once

#include <string>
#include <string_view>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"
#include "engine/result.hpp"

namespace repose::server {

std::string print_fit(const calibrator::Calibration& calibration, const calibrator::Fit& fit);

/// Reads what print_fit() printed for the same calibration; the error is a sentence. Numbers come
/// back to the last digit or two: they were converted to the author's units.
engine::Result<calibrator::Fit, std::string> parse_fit(const calibrator::Calibration& calibration,
                                                       std::string_view text);

/// Where a running calibration stands.
std::string print_progress(const calibrator::Calibration& calibration,
                           const calibrator::Progress& progress);

}  // namespace repose::server
