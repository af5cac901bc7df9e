/// StreamPump: the one thread that asks every open stream for the text that has come up.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

namespace repose::server {

/// The text that has come up since the last call, empty where there is none; or nothing where there
/// will be no more. Called by one thread.
using StreamSource = std::function<std::optional<std::string>()>;

class StreamPump {
 public:
  /// Given the stream's number and its text, or nothing where the source has ended or failed.
  using Deliver = std::function<void(std::uint64_t id, std::optional<std::string> text)>;

  StreamPump(std::chrono::milliseconds interval, Deliver deliver);
  StreamPump(const StreamPump&) = delete;
  StreamPump& operator=(const StreamPump&) = delete;

  void add(std::uint64_t id, StreamSource source);
  void remove(std::uint64_t id);
  /// What was delivered has gone out: a reader that is slow is not asked for.
  void ready(std::uint64_t id);

 private:
  struct Stream {
    std::shared_ptr<StreamSource> source;  ///< shared: a stream may be removed while it is asked
    bool ready = true;
  };
  void pump(const std::stop_token& stop);
  void round();

  std::chrono::milliseconds interval_;
  Deliver deliver_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::map<std::uint64_t, Stream> streams_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace repose::server
