#include "server/jobs/schedule.hpp"

#include <algorithm>

namespace repose::server {

bool Schedule::submit(Job job) {
  if (running_ == job || std::ranges::find(waiting_, job) != waiting_.end()) return false;
  waiting_.push_back(job);
  return true;
}

std::optional<Job> Schedule::next() {
  if (!ready()) return std::nullopt;
  running_ = waiting_.front();
  waiting_.pop_front();
  return running_;
}

void Schedule::finished() { running_.reset(); }

Schedule::Cancelled Schedule::cancel(Job job) {
  if (running_ == job) return Cancelled::running;
  const auto found = std::ranges::find(waiting_, job);
  if (found == waiting_.end()) return Cancelled::unknown;
  waiting_.erase(found);
  return Cancelled::waiting;
}

}  // namespace repose::server
