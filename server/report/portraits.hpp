/// Portraits: a study's experiments run once at the best set, for the pictures of the report.
#pragma once

#include <stop_token>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"
#include "server/report/report.hpp"

namespace repose::server {

/// Each experiment of the study once, at the study's exploration fidelity, on threads of this
/// process. The last stage of a run is its picture; a run with a handful of grains (a drop test)
/// has none, nor has one that failed before its first stage.
std::vector<ReportPicture> portraits(const calibrator::Calibration& calibration,
                                     const calibrator::Fit& fit,
                                     std::stop_token stop);

}  // namespace repose::server
