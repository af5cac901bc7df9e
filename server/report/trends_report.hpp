/// The page of a laboratory's trends: a small plot for every parameter and observable.
#pragma once

#include <string>

#include "server/laboratory/trends.hpp"

namespace repose::server {

/// `command` is what made it.
std::string print_trends_report(const Trends& trends, const std::string& command);

}  // namespace repose::server
