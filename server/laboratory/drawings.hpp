/// Drawings of the experiments in letters, for a terminal.
#pragma once

#include <string_view>

namespace repose::server {

/// Begins with a new line and ends without; empty where there is none of that name.
std::string_view drawing_of(std::string_view experiment);

}  // namespace repose::server
