/// Guard: refuses what the HTTP library would take in good faith, before a body is read. Found by
/// trying Debian's cpp-httplib 0.11.4 with hostile requests.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace repose::server {

/// Largest body that is read, bytes.
inline constexpr std::size_t largest_body = 1U << 20U;

/// The head of a request: its header fields as they were decoded.
struct RequestHead {
  std::string method;
  std::vector<std::pair<std::string, std::string>> fields;
  std::size_t ranges = 0;
};

struct HeadRefusal {
  int status;
  std::string detail;
};

/// Why a request is refused, if it is. `names` are the hosts this server answers for, beside the
/// loopback's names; a foreign one is what DNS rebinding looks like.
std::optional<HeadRefusal> refuse(const RequestHead& head, const std::vector<std::string>& names);

}  // namespace repose::server
