/// The time of day, for rows and documents.
#pragma once

#include <chrono>
#include <cstdint>

namespace repose::server {

/// Microseconds since 1970 UTC.
inline std::int64_t microseconds_now() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace repose::server
