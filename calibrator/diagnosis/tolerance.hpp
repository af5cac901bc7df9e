/// Tolerance: how closely two right DEM codes agree on an observable, which is as closely as any
/// model's word is taken.
///
/// Each observable brings its spread between codes (engine/experiments). A measurement's allowance
/// takes its place, and what is stated for a diagnosis or a comparison that of both.
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

/// Relative: what is stated, else the measurement's allowance, else the observable's own spread.
double tolerance_of(const Measurement& measurement, const Tolerances& stated);

}  // namespace repose::calibrator
