#include "server/jobs/job_queue.hpp"

#include <algorithm>

namespace repose::server {

bool JobQueue::submit(Job job) {
  if (running_ == job || std::ranges::find(waiting_, job) != waiting_.end()) return false;
  waiting_.push_back(job);
  return true;
}

std::optional<Job> JobQueue::next() {
  if (!ready()) return std::nullopt;
  running_ = waiting_.front();
  waiting_.pop_front();
  return running_;
}

void JobQueue::finished() { running_.reset(); }

JobQueue::Cancelled JobQueue::cancel(Job job) {
  if (running_ == job) return Cancelled::running;
  const auto found = std::ranges::find(waiting_, job);
  if (found == waiting_.end()) return Cancelled::unknown;
  waiting_.erase(found);
  return Cancelled::waiting;
}

}  // namespace repose::server
