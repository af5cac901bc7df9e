/// Comparisons and diagnoses as text for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace repose::server {

/// `calibration` and `comparison`: the service's documents.
std::string print_comparison_text(std::string_view calibration, std::string_view comparison);
std::string print_diagnosis_text(std::string_view calibration, std::string_view diagnosis);

}  // namespace repose::server
