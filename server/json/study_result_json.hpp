/// StudyResult -> JSON: every row with the paper's value, ours, the difference and the trend.
#pragma once

#include <string>

#include "server/studies/study_result.hpp"

namespace repose::server {

/// Pure: equal results give equal text. Numbers are in the paper's units, named beside them.
std::string print_study_result(const StudyResult& result);

}  // namespace repose::server
