/// JobQueue: which jobs wait, and which runs. A value: no threads, no clock, no store.
#pragma once

#include <compare>
#include <cstdint>
#include <deque>
#include <optional>

namespace repose::server {

/// A calibration or a diagnosis that is to be run.
struct Job {
  enum class Kind : std::uint8_t { calibration, diagnosis };
  Kind kind = Kind::calibration;
  std::int64_t id = 0;

  auto operator<=>(const Job&) const = default;
};

class JobQueue {
 public:
  /// Puts a job at the end of the queue; false where it waits or runs already: it stays there.
  bool submit(Job job);
  /// The next one to run, which runs from now on; none while one runs.
  std::optional<Job> next();
  /// The running one has ended.
  void finished();

  enum class Cancelled : std::uint8_t { waiting, running, unknown };
  /// Takes a waiting one out; a running one must be asked to stop.
  Cancelled cancel(Job job);

  [[nodiscard]] std::optional<Job> running() const { return running_; }
  [[nodiscard]] bool ready() const { return !running_ && !waiting_.empty(); }

 private:
  std::deque<Job> waiting_;
  std::optional<Job> running_;
};

}  // namespace repose::server
