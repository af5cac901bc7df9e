#include "server/api/connection.hpp"

namespace repose::server {

namespace {

using std::chrono::milliseconds;

/// For a client to read its last answer while it still sends.
constexpr milliseconds farewell{1000};

milliseconds patience_of(RequestReader::Progress progress, const TransportLimits& limits) {
  switch (progress) {
    case RequestReader::Progress::empty:
      return limits.idle;
    case RequestReader::Progress::body:
      return limits.body;
    case RequestReader::Progress::head:
    case RequestReader::Progress::whole:
    case RequestReader::Progress::refused:
      return limits.head;
  }
  return limits.head;
}

}  // namespace

milliseconds patience(const Connection& connection, const TransportLimits& limits) {
  switch (connection.phase) {
    case Phase::reading:
      return patience_of(connection.reader.progress(), limits);
    case Phase::working:
      return milliseconds::max();
    case Phase::writing:
      return limits.write;
    case Phase::streaming:
      return connection.out.empty() ? limits.heartbeat : limits.write;
    case Phase::leaving:
      return farewell;
  }
  return limits.idle;
}

}  // namespace repose::server
