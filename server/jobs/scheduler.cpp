#include "server/jobs/scheduler.hpp"

#include <utility>

namespace repose::server {

Scheduler::Scheduler(Runner run)
    : run_(std::move(run)), thread_([this](const std::stop_token& stop) { obey(stop); }) {}

Scheduler::~Scheduler() {
  thread_.request_stop();
  const std::scoped_lock hold(mutex_);
  running_.request_stop();
}

bool Scheduler::submit(Job job) {
  bool is_new = false;
  {
    const std::scoped_lock hold(mutex_);
    is_new = queue_.submit(job);
  }
  changed_.notify_all();
  return is_new;
}

JobQueue::Cancelled Scheduler::cancel(Job job) {
  const std::scoped_lock hold(mutex_);
  const JobQueue::Cancelled result = queue_.cancel(job);
  if (result == JobQueue::Cancelled::running) running_.request_stop();
  return result;
}

void Scheduler::obey(const std::stop_token& stop) {
  std::unique_lock hold(mutex_);
  while (changed_.wait(hold, stop, [this] { return queue_.ready(); })) {
    if (stop.stop_requested()) return;
    const auto job = queue_.next();
    running_ = std::stop_source();
    const std::stop_token token = running_.get_token();
    hold.unlock();
    run_(*job, token);
    hold.lock();
    queue_.finished();
  }
}

}  // namespace repose::server
