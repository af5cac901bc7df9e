#include "server/cli/interrupt.hpp"

#include <atomic>
#include <cerrno>
#include <fcntl.h>
#include <signal.h>
#include <system_error>
#include <unistd.h>

namespace repose::server {

namespace {

std::atomic<int> handler_pipe = -1;
constexpr char signalled = 's', closing = 'c';

extern "C" void on_signal(int /*number*/) {
  const int saved = errno;
  // Nothing to be done where the pipe is full: one letter is enough.
  [[maybe_unused]] const auto written = write(handler_pipe.load(), &signalled, 1);
  errno = saved;
}

void handle(int number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(number, &action, nullptr);
}

}  // namespace

Interrupt::Interrupt() : pipe_{-1, -1} {
  if (pipe2(pipe_, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  handler_pipe = pipe_[1];
  watcher_ = std::jthread([this] {
    char letter = closing;
    while (read(pipe_[0], &letter, 1) < 0 && errno == EINTR) {
    }
    if (letter == signalled) stop_.request_stop();
  });
  handle(SIGINT, on_signal);
  handle(SIGTERM, on_signal);
}

Interrupt::~Interrupt() {
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  [[maybe_unused]] const auto written = write(pipe_[1], &closing, 1);
  watcher_.join();
  close(pipe_[0]);
  close(pipe_[1]);
}

void ignore_interrupts() { signal(SIGINT, SIG_IGN); }

}  // namespace repose::server
