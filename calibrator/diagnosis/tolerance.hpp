/// Tolerance: how closely two right DEM codes agree on an observable, which is as closely as any
/// model's word is taken.
///
/// Each observable brings its spread between codes (engine/experiments); a diagnosis or a comparison
/// may state another.
///
/// The size of an angle is that of its tangent: sin(2 y) / 2 rad for 100 %.
#pragma once

#include <string>

#include "calibrator/diagnosis/diagnosis.hpp"
#include "calibrator/measurement.hpp"

namespace repose::calibrator {

std::string observable_name(const Measurement& measurement);  ///< "tilting_box.static_angle"

/// What 100 % of a measurement is, in its unit (SI).
double size_of(const Measurement& measurement);

/// Relative: the observable's own spread between codes, unless `stated` has another.
double tolerance_of(const Measurement& measurement, const Tolerances& stated);

/// How far the model's word is taken, SI: to the tolerance, or to the measurement's allowance where
/// that is larger. One is not added to the other: both say what a model may be off by.
double model_error_of(const Measurement& measurement, const Tolerances& stated);

}  // namespace repose::calibrator
