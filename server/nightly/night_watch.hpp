/// NightWatch: the thread that looks at the clock.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace repose::server {

class NightWatch {
 public:
  using Look = std::function<void(const std::stop_token& stop)>;

  /// Calls `look` at once, and then several times a minute: so a clock that is set, or a machine
  /// that slept, delays no night for long.
  explicit NightWatch(Look look);

 private:
  void watch(const std::stop_token& stop);

  Look look_;
  std::mutex mutex_;
  std::condition_variable_any never_;  ///< waited for until a stop or the next look
  std::jthread thread_;                // last: it uses all of the above
};

}  // namespace repose::server
