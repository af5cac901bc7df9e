/// Tolerance: how closely two right DEM codes agree on an observable, which is as closely as any
/// model's word is taken.
///
/// Each observable brings its spread between codes (engine/experiments); a study may state another.
/// Readings of one observable share most of the offset, but not all: a drum at 15, 30 and 60 rpm
/// was 5 and 8 % steeper and 6 % flatter than another code's.
///
///   Cov(t_i, t_j) = 0.75 tau_i tau_j + 0.25 tau_i^2 [i = j],   tau_j = spread x size of y_j
///
/// The size of an angle is that of its tangent: sin(2 y) / 2 rad for 100 %.
#pragma once

#include <span>
#include <string>

#include <Eigen/Core>

#include "calibrator/diagnosis/diagnosis.hpp"
#include "calibrator/measurement.hpp"

namespace repose::calibrator {

std::string observable_name(const Measurement& measurement);  ///< "tilting_box.static_angle"

/// What 100 % of a measurement is, in its unit (SI).
double size_of(const Measurement& measurement);

/// The observable's own spread between codes, unless `stated` has another.
double tolerance_of(const Measurement& measurement, const Tolerances& stated);

/// Of measurements: standard errors and allowances, and the shared tolerance.
Eigen::MatrixXd covariance_of(std::span<const Measurement> measurements, const Tolerances& stated);

}  // namespace repose::calibrator
