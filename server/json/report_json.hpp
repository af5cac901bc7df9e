/// A calibration's document -> structs, for those who show it: the report and the command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"
#include "engine/result.hpp"

namespace repose::server {

/// What the service keeps of a calibration.
struct CalibrationDocument {
  std::int64_t id = 0;
  std::string name;
  std::string state;
  std::string created_at, started_at, finished_at;  ///< ISO 8601; empty where it has not come to it
  std::string error;
  std::string engine_version;  ///< that answered; empty where the document does not say
  std::optional<calibrator::Calibration> calibration;
  std::optional<calibrator::Fit> fit;
  std::string study;  ///< as JSON, indented for people
};

/// Reads Service::calibration()'s text; the error is a sentence.
engine::Result<CalibrationDocument, std::string> parse_document(std::string_view text);

/// One line of the list of calibrations.
struct CalibrationItem {
  std::int64_t id = 0;
  std::string name, state, created_at;
};

/// Reads Service::calibrations()'s text.
std::vector<CalibrationItem> parse_items(std::string_view text);

}  // namespace repose::server
