/// Problems -> document (schemas/problem.schema.json, RFC 9457).
#pragma once

#include <string>
#include <string_view>

#include "server/json/problem.hpp"

namespace repose::server {

struct ProblemDocument {
  std::string_view type;   ///< a name that does not change, as URI
  std::string_view title;  ///< the same for every problem of that type
  int status = 500;
  std::string detail;  ///< of this one
  Problems errors;
};

std::string print_problem(const ProblemDocument& problem);

}  // namespace repose::server
