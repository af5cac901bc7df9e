/// Scheduler: the thread that obeys a JobQueue, one job at a time.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

#include "server/jobs/job_queue.hpp"

namespace repose::server {

class Scheduler {
 public:
  using Runner = std::function<void(const Job& job, const std::stop_token& stop)>;

  /// `run` runs a job to its end; it must not throw.
  explicit Scheduler(Runner run);
  /// Asks the running job to stop and waits for it.
  ~Scheduler();
  Scheduler(const Scheduler&) = delete;
  Scheduler& operator=(const Scheduler&) = delete;

  bool submit(Job job);  ///< as JobQueue's
  JobQueue::Cancelled cancel(Job job);

 private:
  void obey(const std::stop_token& stop);

  Runner run_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  JobQueue queue_;
  std::stop_source running_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace repose::server
