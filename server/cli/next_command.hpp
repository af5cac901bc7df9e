/// Next command: what there is to type after a command has ended, or has been interrupted.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "calibrator/diagnosis/diagnosis.hpp"
#include "server/cli/commands.hpp"
#include "server/json/report_json.hpp"

namespace repose::server {

/// A word as a shell reads it: in quotes where it needs them.
std::string shell_word(std::string_view word);

/// "repose calibrate 'my study.json' --db r.db --workers 2": what takes the calibration up with all
/// that it was given.
std::string resume_words(const CalibrateCommand& command);

/// Who goes on with a job that waits, and how it is ended.
std::string queued_text(std::int64_t id, Cancelled what, const std::filesystem::path& database);

/// Where a fit misses its measurements: what tells more. Else nothing.
std::string after_fit(const CalibrationDocument& document, const std::filesystem::path& database);

/// Where a diagnosis names what the calibration lacks: what adds it. Else nothing.
std::string after_diagnosis(std::int64_t calibration,
                            const calibrator::Diagnosis& diagnosis,
                            const std::filesystem::path& database);

}  // namespace repose::server
