/// Comparison -> document (schemas/comparison.schema.json): numbers in the units of the
/// calibration's author.
#pragma once

#include <optional>
#include <string>

#include "calibrator/calibration.hpp"
#include "calibrator/comparison.hpp"

namespace repose::server {

/// `before`: the calibration that this one extends.
std::string print_comparison(const calibrator::Calibration& calibration,
                             const calibrator::Comparison& comparison,
                             const std::optional<calibrator::Comparison>& before);

}  // namespace repose::server
