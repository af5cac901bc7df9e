/// Transport: the sockets. One thread reads whole requests under limits and writes answers, a few
/// work them out, one feeds the streams: neither a slow client nor an open stream holds a thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/api/stream_pump.hpp"

namespace repose::server {

struct TransportLimits {
  std::size_t threads = 16;        ///< requests worked out at once
  std::size_t connections = 1024;  ///< when there are more, the one that is idle longest is closed
  std::size_t streams = 200;
  std::size_t waiting = 256;              ///< requests that have come and wait for a thread
  std::size_t memory = 64U << 20U;        ///< bytes of requests and answers under way
  std::chrono::milliseconds head{5000};   ///< for a head to come, from its first byte
  std::chrono::milliseconds body{30000};  ///< for a body
  std::chrono::milliseconds idle{30000};  ///< between two requests
  std::chrono::milliseconds write{30000};
  std::chrono::milliseconds heartbeat{15000};  ///< of a stream on which nothing happens
  std::chrono::milliseconds pump{200};         ///< between two looks for what streams have to say
};

/// What goes back to the client.
struct Output {
  std::string text;  ///< of a stream: its head
  bool keeps_alive = true;
  StreamSource stream = {};
};

/// How much is under way.
struct TransportFigures {
  std::size_t connections = 0;
  std::size_t streams = 0;
  std::size_t waiting = 0;
};

class Transport {
 public:
  /// Works out a request that came whole; on several threads at once.
  using Answer = std::function<Output(const std::string& request, bool keeps_alive)>;
  /// The whole answer of a request that never reaches `Answer`.
  using Refuse = std::function<std::string(int status, const std::string& detail)>;

  /// `listener` is a bound socket that listens; it stays the caller's.
  Transport(int listener,
            std::vector<std::string> names,
            const TransportLimits& limits,
            Answer answer,
            Refuse refuse);
  ~Transport();
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;

  /// Serves until stop(), then finishes the requests in work and ends the streams.
  void run();
  /// From any thread, also before run().
  void stop();

  [[nodiscard]] TransportFigures figures() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace repose::server
