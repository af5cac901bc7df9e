#include "server/jobs/watch.hpp"

#include <utility>

namespace repose::server {

Watch::Watch(std::chrono::seconds every, Look look)
    : every_(every),
      look_(std::move(look)),
      thread_([this](const std::stop_token& stop) { watch(stop); }) {}

void Watch::watch(const std::stop_token& stop) {
  std::unique_lock hold(mutex_);
  while (!stop.stop_requested()) {
    look_(stop);
    never_.wait_for(hold, stop, every_, [] { return false; });
  }
}

}  // namespace repose::server
