/// Scheduler: the thread that obeys a Schedule, one calibration at a time.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

#include "server/jobs/schedule.hpp"

namespace repose::server {

class Scheduler {
 public:
  using Job = std::function<void(std::int64_t id, const std::stop_token& stop)>;

  /// `job` runs a calibration to its end; it must not throw.
  explicit Scheduler(Job job);
  /// Asks the running job to stop and waits for it.
  ~Scheduler();
  Scheduler(const Scheduler&) = delete;
  Scheduler& operator=(const Scheduler&) = delete;

  void submit(std::int64_t id);
  Schedule::Cancelled cancel(std::int64_t id);

 private:
  void obey(const std::stop_token& stop);

  Job job_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  Schedule schedule_;
  std::stop_source running_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace repose::server
