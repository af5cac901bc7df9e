/// What a command that was interrupted says: how its work goes on, and how it is ended.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "server/cli/commands.hpp"

namespace repose::server {

/// A word as a shell reads it: in quotes where it needs them.
std::string shell_word(std::string_view word);

/// "repose calibrate 'my study.json' --db r.db --workers 2": what takes the calibration up with all
/// that it was given.
std::string resume_words(const CalibrateCommand& command);

/// Who goes on with a job that waits, and how it is ended.
std::string queued_text(std::int64_t id, Cancelled what, const std::filesystem::path& database);

}  // namespace repose::server
