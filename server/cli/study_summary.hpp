/// A study that was run again, as text for a terminal.
#pragma once

#include <string>

#include "server/studies/study_result.hpp"

namespace repose::server {

std::string print_study_summary(const StudyResult& result);

}  // namespace repose::server
