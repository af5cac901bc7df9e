/// Charts of a fit, as SVG text. Widths fit a phone; colours come from the page's style sheet.
#pragma once

#include <string>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"
#include "server/report/fit_line.hpp"
#include "server/report/svg.hpp"

namespace repose::server {

/// Every measurement on an axis of its own, in its own unit: measured with +-1 and +-2 standard
/// errors, predicted with its standard error; a curve over its setting.
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

/// The samples of the posterior, every parameter against every other.
std::string posterior_chart(const calibrator::Calibration& calibration, const calibrator::Fit& fit);

/// Where a value lies between the bounds, 0 to 1, by the parameter's own scale.
double share_of_range(const calibrator::FreeParameter& free, double value);

/// A curve: measured points with their standard errors, predicted ones joined by a line.
inline constexpr double curve_height = 170.0;
void draw_curve(Svg& svg, double top, double width, const FitLine& line);

/// How a difference of z standard errors is called: "good" (1), "fair" (2), "poor".
const char* grade(double z);

}  // namespace repose::server
