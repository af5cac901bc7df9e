/// Problem: one thing wrong with a request: where, what was found, what is allowed.
#pragma once

#include <string>
#include <vector>

namespace repose::server {

struct Problem {
  std::string pointer;  ///< JSON pointer (RFC 6901) into the request; "" is the whole document
  std::string message;  ///< a sentence
  std::string found;    ///< what stands there, as text
  std::string allowed;  ///< what may stand there
};

using Problems = std::vector<Problem>;

/// "1 problem", "3 problems"
inline std::string counted(const Problems& problems) {
  return std::to_string(problems.size()) + (problems.size() == 1 ? " problem" : " problems");
}

}  // namespace repose::server
