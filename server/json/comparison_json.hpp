/// Comparison -> document (schemas/comparison.schema.json): numbers in the units of the
/// calibration's author.
#pragma once

#include <optional>
#include <string>

#include "calibrator/calibration.hpp"
#include "calibrator/comparison.hpp"
#include "calibrator/diagnosis/tolerated.hpp"
#include "server/json/text.hpp"

namespace repose::server {

/// `tolerated`: where the comparison finds no fit. `before`: the calibration that this one extends.
std::string print_comparison(const calibrator::Calibration& calibration,
                             const calibrator::Comparison& comparison,
                             const std::optional<calibrator::Tolerated>& tolerated,
                             const std::optional<calibrator::Comparison>& before);

/// {"misfit","freedom","p","fitted_z","held_out_z"}
Json print_fit_quality(const calibrator::Comparison& comparison);

}  // namespace repose::server
