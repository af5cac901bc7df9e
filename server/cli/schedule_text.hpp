/// Schedules and their nights as text for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace repose::server {

std::string print_schedule_text(std::string_view document);   ///< Service::schedule()'s
std::string print_schedules_text(std::string_view document);  ///< Service::schedules()'s
std::string print_nights_text(std::string_view document);     ///< Service::nights()'s

}  // namespace repose::server
