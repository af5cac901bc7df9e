/// The published studies that live in the program: server/studies/*.json -> PublishedStudy.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/studies/published_study.hpp"

namespace repose::server {

std::vector<std::string> published_study_names();

/// Null where there is no such study.
const PublishedStudy* find_published_study(std::string_view name);

}  // namespace repose::server
