/// Connection: what a socket is at, and for how long it may be.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

#include "server/api/request_reader.hpp"
#include "server/api/transport.hpp"

namespace repose::server {

enum class Phase {
  reading,    ///< a request, or waiting for one
  working,    ///< its request is being worked out
  writing,    ///< the answer
  streaming,  ///< an answer that does not end
  leaving,    ///< the last answer has been written; what still comes is thrown away
};

struct Connection {
  using Clock = std::chrono::steady_clock;

  std::uint64_t id = 0;
  int socket = -1;
  RequestReader reader;
  Phase phase = Phase::reading;
  Clock::time_point since = {};  ///< of its phase; while it reads, of the reader's progress; while
                                 ///< it writes, of the last byte that went out
  std::string out = {};
  std::size_t written = 0;
  bool keeps_alive = true;

  void enter(Phase next) {
    phase = next;
    since = Clock::now();
  }
  /// Bytes that it holds at present or will.
  [[nodiscard]] std::size_t size() const { return reader.size() + out.size(); }
};

/// How long a connection may stay as it is.
std::chrono::milliseconds patience(const Connection& connection, const TransportLimits& limits);

}  // namespace repose::server
