/// Watch: a thread that looks whether something is due.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace repose::server {

class Watch {
 public:
  using Look = std::function<void(const std::stop_token& stop)>;

  /// Calls `look` at once, and then again and again: so a clock that is set, or a machine that
  /// slept, delays nothing for long.
  Watch(std::chrono::seconds every, Look look);

 private:
  void watch(const std::stop_token& stop);

  std::chrono::seconds every_;
  Look look_;
  std::mutex mutex_;
  std::condition_variable_any never_;  ///< waited for until a stop or the next look
  std::jthread thread_;                // last: it uses all of the above
};

}  // namespace repose::server
