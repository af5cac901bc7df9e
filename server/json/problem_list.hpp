/// ProblemList: gathers what is wrong with a request, up to a number that a person can read.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include "server/json/problem.hpp"

namespace repose::server {

class ProblemList {
 public:
  void add(Problem problem) {
    if (kept_.size() < most) {
      kept_.push_back(std::move(problem));
    } else {
      ++dropped_;
    }
  }
  [[nodiscard]] bool empty() const { return kept_.empty(); }

  /// All of them; past the limit their number stands for the rest.
  [[nodiscard]] Problems all() const {
    Problems result = kept_;
    if (dropped_ > 0) {
      result.push_back({"", std::to_string(dropped_) + " more problems are not listed", "", ""});
    }
    return result;
  }

 private:
  /// A megabyte of mistakes must not become twenty megabytes of complaints.
  static constexpr std::size_t most = 100;
  Problems kept_;
  std::size_t dropped_ = 0;
};

}  // namespace repose::server
