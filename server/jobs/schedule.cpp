#include "server/jobs/schedule.hpp"

#include <algorithm>

namespace repose::server {

void Schedule::submit(std::int64_t id) {
  if (running_ == id || std::ranges::find(waiting_, id) != waiting_.end()) return;
  waiting_.push_back(id);
}

std::optional<std::int64_t> Schedule::next() {
  if (!ready()) return std::nullopt;
  running_ = waiting_.front();
  waiting_.pop_front();
  return running_;
}

void Schedule::finished() { running_.reset(); }

Schedule::Cancelled Schedule::cancel(std::int64_t id) {
  if (running_ == id) return Cancelled::running;
  const auto found = std::ranges::find(waiting_, id);
  if (found == waiting_.end()) return Cancelled::unknown;
  waiting_.erase(found);
  return Cancelled::waiting;
}

}  // namespace repose::server
