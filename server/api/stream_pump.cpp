#include "server/api/stream_pump.hpp"

#include <exception>
#include <utility>
#include <vector>

namespace repose::server {

StreamPump::StreamPump(std::chrono::milliseconds interval, Deliver deliver)
    : interval_(interval),
      deliver_(std::move(deliver)),
      thread_([this](const std::stop_token& stop) { pump(stop); }) {}

void StreamPump::add(std::uint64_t id, StreamSource source) {
  {
    const std::scoped_lock hold(mutex_);
    streams_[id] = {std::make_shared<StreamSource>(std::move(source)), true};
  }
  changed_.notify_all();
}

void StreamPump::remove(std::uint64_t id) {
  const std::scoped_lock hold(mutex_);
  streams_.erase(id);
}

void StreamPump::ready(std::uint64_t id) {
  const std::scoped_lock hold(mutex_);
  if (const auto found = streams_.find(id); found != streams_.end()) found->second.ready = true;
}

/// Asks outside of the lock, so that a source that waits for the store holds up nobody.
void StreamPump::round() {
  std::vector<std::pair<std::uint64_t, std::shared_ptr<StreamSource>>> asked;
  {
    const std::scoped_lock hold(mutex_);
    for (const auto& [id, stream] : streams_) {
      if (stream.ready) asked.emplace_back(id, stream.source);
    }
  }
  for (const auto& [id, source] : asked) {
    std::optional<std::string> text;
    try {
      text = (*source)();
    } catch (const std::exception&) {
      text = std::nullopt;  // the client comes again and takes up where it was
    }
    if (text && text->empty()) continue;
    {
      const std::scoped_lock hold(mutex_);
      if (const auto found = streams_.find(id); found != streams_.end()) {
        found->second.ready = false;
      }
    }
    deliver_(id, std::move(text));
  }
}

void StreamPump::pump(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    {
      std::unique_lock hold(mutex_);
      changed_.wait(hold, stop, [this] { return !streams_.empty(); });
    }
    if (stop.stop_requested()) return;
    round();
    std::unique_lock hold(mutex_);
    changed_.wait_for(hold, stop, interval_, [] { return false; });
  }
}

}  // namespace repose::server
