#include "server/nightly/night_watch.hpp"

#include <chrono>
#include <utility>

namespace repose::server {

NightWatch::NightWatch(Look look)
    : look_(std::move(look)), thread_([this](const std::stop_token& stop) { watch(stop); }) {}

void NightWatch::watch(const std::stop_token& stop) {
  std::unique_lock hold(mutex_);
  while (!stop.stop_requested()) {
    look_(stop);
    never_.wait_for(hold, stop, std::chrono::seconds(15), [] { return false; });
  }
}

}  // namespace repose::server
