/// The study document (schemas/calibration.schema.json) <-> Calibration. Parsed, checked and
/// converted to SI once, here.
#pragma once

#include <string>
#include <string_view>

#include "calibrator/calibration.hpp"
#include "engine/result.hpp"
#include "server/json/problem.hpp"

namespace repose::server {

/// All problems of the text at once, or the calibration.
engine::Result<calibrator::Calibration, Problems> parse_calibration(std::string_view text);

/// The canonical document: equal calibrations give equal text, and parsing it gives the calibration
/// back.
std::string print_calibration(const calibrator::Calibration& calibration);

}  // namespace repose::server
