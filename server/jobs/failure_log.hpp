/// FailureLog: work that is done again and again, and its failures, each told once.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <string>

namespace repose::server {

class FailureLog {
 public:
  /// Does the work; false where it throws. A failure is told in the log unless it is the one that
  /// this work had the last time.
  bool run(const std::string& name, const std::function<void()>& work);
  /// Whether all work went well when it was done last.
  [[nodiscard]] bool empty() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::string> failures_;  ///< of work that failed the last time
};

}  // namespace repose::server
