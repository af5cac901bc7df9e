#include "server/jobs/child.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace repose::server {

#ifdef REPOSE_SANITIZED
const bool limits_memory = false;
#else
const bool limits_memory = true;
#endif

namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(int code, const char* doing) {
  throw std::system_error(code, std::generic_category(), doing);
}

/// A descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  void reset(int number = -1) {
    if (number_ >= 0) close(number_);
    number_ = number;
  }
  [[nodiscard]] int get() const { return number_; }

 private:
  int number_;
};

void make_pipe(Descriptor& read_end, Descriptor& write_end) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) fail(errno, "cannot make a pipe for an evaluation");
  read_end.reset(ends[0]);
  write_end.reset(ends[1]);
}

pid_t start(const std::filesystem::path& program, int input, int output) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  sigset_t defaults;
  sigemptyset(&defaults);
  sigaddset(&defaults, SIGPIPE);
  sigaddset(&defaults, SIGTERM);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::string name = program.string();
  std::string verb = "answer";
  std::array<char*, 3> arguments{name.data(), verb.data(), nullptr};
  pid_t child = 0;
  const int code =
      posix_spawn(&child, name.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (code != 0) fail(code, "cannot start an evaluation's process");
  return child;
}

/// A question is far smaller than a pipe holds, so this does not block.
void give(int to, const std::string& text) {
  std::size_t given = 0;
  while (given < text.size()) {
    const ssize_t count = write(to, text.data() + given, text.size() - given);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(errno, "cannot hand over a question");
    given += static_cast<std::size_t>(count);
  }
}

/// From outside: what is started may be any program.
void limit_memory(pid_t child, std::uint64_t bytes) {
  if (!limits_memory || bytes == 0) return;
  const rlimit limit{bytes, bytes};
  prlimit(child, RLIMIT_AS, &limit, nullptr);  // fails only where the child has ended already
}

/// How a process ended that was not left to its end.
std::string cut_off(ChildResult::End end, const ChildLimits& limits) {
  using End = ChildResult::End;
  if (end == End::cancelled) return "was asked to stop";
  if (end == End::timed_out) {
    return "ran past its time limit of " + std::to_string(limits.seconds) + " s";
  }
  if (end == End::silent)
    return "gave no sign of life for " + std::to_string(limits.silence) + " s";
  return "wrote without end";
}

void end_group(pid_t child) {
  // Stopped or deaf, the whole group ends: an evaluation has nothing to clean up.
  kill(-child, SIGKILL);
}

}  // namespace

ChildResult run_child(const std::filesystem::path& program,
                      const std::string& input,
                      const ChildLimits& limits,
                      const std::stop_token& stop) {
  Descriptor question_out, question_in, answer_out, answer_in;
  make_pipe(question_out, question_in);
  make_pipe(answer_out, answer_in);
  const pid_t child = start(program, question_out.get(), answer_in.get());
  limit_memory(child, limits.bytes);
  // Not before the limit holds; and while both ends are open here: no broken pipe.
  give(question_in.get(), input);
  question_out.reset();
  question_in.reset();
  answer_in.reset();

  ChildResult result;
  const auto deadline = Clock::now() + std::chrono::duration<double>(limits.seconds);
  auto heard = Clock::now();
  std::array<char, 16384> buffer{};
  int status = 0;
  bool ended = false;
  for (bool open = true; !ended;) {
    pollfd watched{answer_out.get(), POLLIN, 0};
    constexpr int look_up = 50;  // ms between looks at the clock and the stop token
    // One that has closed its output but lives on is watched all the same.
    if (!open) watched.fd = -1;
    if (poll(&watched, 1, open ? look_up : 1) > 0) {
      const ssize_t count = read(answer_out.get(), buffer.data(), buffer.size());
      if (count > 0) result.output.append(buffer.data(), static_cast<std::size_t>(count));
      if (count > 0) heard = Clock::now();
      open = count > 0 || (count < 0 && errno == EINTR);
    }
    if (!open) ended = waitpid(child, &status, WNOHANG) == child;
    if (ended) break;
    const auto now = Clock::now();
    if (now - heard >= std::chrono::duration<double>(limits.silence)) {
      result.end = ChildResult::End::silent;
    }
    if (now >= deadline) result.end = ChildResult::End::timed_out;
    if (stop.stop_requested()) result.end = ChildResult::End::cancelled;
    constexpr std::size_t longest = 16U << 20U;  // bytes; an answer has some hundreds
    if (result.output.size() > longest) result.end = ChildResult::End::died;
    if (result.end != ChildResult::End::exited) {
      end_group(child);
      break;
    }
  }
  while (!ended && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (result.end != ChildResult::End::exited) {
    result.account = cut_off(result.end, limits);
  } else if (WIFSIGNALED(status)) {
    result.end = ChildResult::End::died;
    result.account = std::string("died by signal ") + strsignal(WTERMSIG(status));
  } else {
    result.exit_code = WEXITSTATUS(status);
    result.account = "ended with exit code " + std::to_string(result.exit_code);
  }
  return result;
}

}  // namespace repose::server
