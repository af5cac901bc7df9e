/// Charts of a fit, as SVG text. Widths fit a phone; colours come from the page's style sheet.
#pragma once

#include <string>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"

namespace repose::server {

/// Every measurement on an axis of its own, in its own unit: measured with +-1 and +-2 standard
/// errors, predicted with its standard error.
std::string parity_chart(const calibrator::Calibration& calibration, const calibrator::Fit& fit);

/// The differences in standard errors, with bands at 1 and 2.
std::string residual_chart(const calibrator::Calibration& calibration, const calibrator::Fit& fit);

/// Misfit of every evaluation and the best expected one so far, logarithmic, coloured by stage.
std::string convergence_chart(const calibrator::Calibration& calibration,
                              const calibrator::Fit& fit);

/// Every free parameter within its bounds: best value and 95 % interval; hatched where the data do
/// not determine it.
std::string interval_chart(const calibrator::Calibration& calibration, const calibrator::Fit& fit);

/// Directions in parameter space and how well the data fix each.
std::string direction_chart(const calibrator::Calibration& calibration, const calibrator::Fit& fit);

/// How a difference of z standard errors is called: "good" (1), "fair" (2), "poor".
const char* grade(double z);

}  // namespace repose::server
