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
    is_new = schedule_.submit(job);
  }
  changed_.notify_all();
  return is_new;
}

Schedule::Cancelled Scheduler::cancel(Job job) {
  const std::scoped_lock hold(mutex_);
  const Schedule::Cancelled result = schedule_.cancel(job);
  if (result == Schedule::Cancelled::running) running_.request_stop();
  return result;
}

void Scheduler::obey(const std::stop_token& stop) {
  std::unique_lock hold(mutex_);
  while (changed_.wait(hold, stop, [this] { return schedule_.ready(); })) {
    if (stop.stop_requested()) return;
    const auto job = schedule_.next();
    running_ = std::stop_source();
    const std::stop_token token = running_.get_token();
    hold.unlock();
    run_(*job, token);
    hold.lock();
    schedule_.finished();
  }
}

}  // namespace repose::server
