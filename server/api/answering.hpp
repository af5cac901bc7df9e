/// Answering: the threads that work out requests, and the two queues between them and the sockets.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "server/api/request_reader.hpp"
#include "server/api/transport.hpp"

namespace repose::server {

class Answering {
 public:
  struct Done {
    std::uint64_t id = 0;  ///< of the connection
    Output output;
  };

  /// `wake` is called after each answer, by the thread that found it.
  Answering(std::size_t threads, Transport::Answer answer, std::function<void()> wake);
  Answering(const Answering&) = delete;
  Answering& operator=(const Answering&) = delete;

  void ask(std::uint64_t id, WholeRequest request);
  /// Those that have been answered since the last call.
  std::deque<Done> take();
  /// Requests that no thread has taken up yet.
  [[nodiscard]] std::size_t waiting() const;

 private:
  struct Question {
    std::uint64_t id = 0;
    WholeRequest request;
  };
  void work(const std::stop_token& stop);

  Transport::Answer answer_;
  std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable_any asked_;
  std::deque<Question> questions_;
  std::deque<Done> done_;
  std::vector<std::jthread> threads_;  // last: they use all of the above
};

}  // namespace repose::server
