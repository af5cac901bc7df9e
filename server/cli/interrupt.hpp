/// Interrupt: Ctrl-C and SIGTERM as a stop token. A second Ctrl-C ends the program at once.
#pragma once

#include <stop_token>
#include <thread>

namespace repose::server {

/// One at a time. While it lives, the first SIGINT or SIGTERM asks its token to stop.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }
  [[nodiscard]] bool happened() const { return stop_.stop_requested(); }

 private:
  int pipe_[2];  // the signal handler writes, the watcher reads
  std::stop_source stop_;
  std::jthread watcher_;
};

/// Lets the parent alone decide when this process ends: a Ctrl-C on the terminal reaches both.
void ignore_interrupts();

}  // namespace repose::server
