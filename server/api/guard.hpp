/// Guard: refuses a request by its head, before a body is read: what the HTTP library would take in
/// good faith, and what a proxy in front may read otherwise than we do. Found by trying Debian's
/// cpp-httplib 0.11.4 with hostile requests.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/result.hpp"

namespace repose::server {

/// Largest body that is read, bytes.
inline constexpr std::size_t largest_body = 1U << 20U;

/// The head of a request as it came: nothing in it is decoded.
struct RequestHead {
  std::string method;
  std::vector<std::pair<std::string, std::string>> fields;
  std::string target = "/";
  bool keeps_alive = true;  ///< HTTP/1.1, and no field says close
};

struct HeadRefusal {
  int status;
  std::string detail;
};

/// Reads a head: the lines up to the empty one, which is not among them.
engine::Result<RequestHead, HeadRefusal> read_head(std::string_view lines);

/// The values of a field, whatever the case of its name.
std::vector<std::string_view> values_of(const RequestHead& head, std::string_view name);

/// Why a request is refused, if it is. `names` are the hosts this server answers for, beside the
/// loopback's names; a foreign one is what DNS rebinding looks like.
std::optional<HeadRefusal> refuse(const RequestHead& head, const std::vector<std::string>& names);

}  // namespace repose::server
