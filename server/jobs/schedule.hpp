/// Schedule: which calibrations wait, and which runs. A value: no threads, no clock, no store.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace repose::server {

class Schedule {
 public:
  /// Puts a calibration at the end of the queue; one that waits or runs already stays where it is.
  void submit(std::int64_t id);
  /// The next one to run, which runs from now on; none while one runs.
  std::optional<std::int64_t> next();
  /// The running one has ended.
  void finished();

  enum class Cancelled : std::uint8_t { waiting, running, unknown };
  /// Takes a waiting one out; a running one must be asked to stop.
  Cancelled cancel(std::int64_t id);

  [[nodiscard]] std::optional<std::int64_t> running() const { return running_; }
  [[nodiscard]] bool ready() const { return !running_ && !waiting_.empty(); }

 private:
  std::deque<std::int64_t> waiting_;
  std::optional<std::int64_t> running_;
};

}  // namespace repose::server
