/// Fit -> document (schemas/fit.schema.json): numbers in the units of the calibration's author.
#pragma once

#include <string>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"

namespace repose::server {

std::string print_fit(const calibrator::Calibration& calibration, const calibrator::Fit& fit);

std::string print_progress(const calibrator::Calibration& calibration,
                           const calibrator::Progress& progress);

}  // namespace repose::server
