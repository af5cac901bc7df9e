/// Served: `repose serve` as a process of its own, which can be killed and started again.
#pragma once

#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <signal.h>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include <httplib.h>

#include "tests/support/program.hpp"

namespace repose::tests {

class Served {
 public:
  /// Starts it with the words of that command line before its own, if any, and waits for its
  /// address.
  explicit Served(std::string database, std::vector<std::string> before = {})
      : database_(std::move(database)), before_(std::move(before)) {
    start();
  }
  ~Served() { end(SIGKILL); }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  void start() {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    child_ = fork();
    if (child_ == 0) {
      dup2(ends[1], STDOUT_FILENO);
      const int nothing = open("/dev/null", O_WRONLY);
      dup2(nothing, STDERR_FILENO);
      std::vector<std::string> words = before_;
      for (const char* word :
           {repose_program.c_str(), "serve", "--port", "0", "--workers", "2", "--db"}) {
        words.emplace_back(word);
      }
      words.push_back(database_);
      std::vector<char*> arguments;
      for (std::string& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      execvp(arguments[0], arguments.data());
      _exit(127);
    }
    close(ends[1]);
    std::string line;
    for (char letter = 0; read(ends[0], &letter, 1) == 1 && letter != '\n';) line += letter;
    close(ends[0]);
    const auto colon = line.rfind(':');
    if (colon == std::string::npos) throw std::runtime_error("repose serve did not start");
    port_ = std::atoi(line.c_str() + colon + 1);
  }
  /// With that signal; its exit status as waitpid() has it.
  int end(int signal) {
    if (child_ <= 0) return 0;
    kill(child_, signal);
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = -1;
    return status;
  }

  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] pid_t process() const { return child_; }
  [[nodiscard]] std::unique_ptr<httplib::Client> client() const {
    auto made = std::make_unique<httplib::Client>("127.0.0.1", port_);
    made->set_tcp_nodelay(true);
    made->set_keep_alive(true);
    return made;
  }

 private:
  std::string database_;
  std::vector<std::string> before_;
  pid_t child_ = -1;
  int port_ = 0;
};

}  // namespace repose::tests
