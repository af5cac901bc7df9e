/// CapturedLog: what is written to the log while it lives.
#pragma once

#include <iostream>
#include <sstream>
#include <string>

namespace repose::tests {

class CapturedLog {
 public:
  CapturedLog() : before_(std::clog.rdbuf(text_.rdbuf())) {}
  ~CapturedLog() { std::clog.rdbuf(before_); }
  CapturedLog(const CapturedLog&) = delete;
  CapturedLog& operator=(const CapturedLog&) = delete;

  [[nodiscard]] std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::streambuf* before_;
};

}  // namespace repose::tests
