/// Summary: a calibration's answer as text for a terminal, and its report as a file.
#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>

#include "server/json/report_json.hpp"

namespace repose::server {

/// Headline, measured and predicted, best set, what was learnt, remarks.
std::string print_summary(const CalibrationDocument& document);

struct ReportFile {
  std::filesystem::path path;
  std::filesystem::path database;  ///< for the provenance
  bool pictures = true;            ///< runs the study's experiments once more
};

/// Writes the HTML report. Throws std::runtime_error where the file cannot be written.
void write_report(const CalibrationDocument& document,
                  const ReportFile& file,
                  std::stop_token stop);

}  // namespace repose::server
