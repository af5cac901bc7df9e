/// Comparisons and diagnoses as text for a terminal.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace repose::server {

/// `calibration` and `comparison`: the service's documents.
std::string print_comparison_text(std::string_view calibration, std::string_view comparison);
/// `database`: for the command that comes next.
std::string print_diagnosis_text(std::string_view calibration,
                                 std::string_view diagnosis,
                                 const std::filesystem::path& database);

}  // namespace repose::server
