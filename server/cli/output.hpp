/// Output: the files that a command leaves, looked at before it begins its work.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "server/cli/input.hpp"

namespace repose::server {

/// What the report of a calibration is called where no name is given: by its database too, so that
/// databases in one folder leave each other's alone. "r-report-6.html" of r.db.
std::filesystem::path report_name(const std::filesystem::path& database, std::int64_t calibration);

/// Why a file cannot be written there; nothing where it can.
std::optional<InputError> objection_to_file(const std::filesystem::path& file);

/// Makes a folder, and those above it, where there is none; why files cannot be written into it.
std::optional<InputError> make_folder(const std::filesystem::path& folder);

}  // namespace repose::server
