/// Study report: a published study that was run again, as one HTML file that needs nothing else.
#pragma once

#include <string>

#include "server/studies/study_result.hpp"

namespace repose::server {

/// What the result does not say of itself.
struct StudyProvenance {
  std::string command;  ///< that made it
  std::string written_at;
};

/// Pure: equal arguments give equal text.
std::string print_study_report(const StudyResult& result, const StudyProvenance& provenance);

}  // namespace repose::server
