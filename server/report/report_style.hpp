/// The style sheet of the report.
#pragma once

#include <string_view>

namespace repose::server {

extern const std::string_view report_style;

}  // namespace repose::server
