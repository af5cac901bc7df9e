/// A reply as HTTP/1.1, for what the library does not print: refusals, and the heads of streams.
#pragma once

#include <string>

#include "server/api/route.hpp"

namespace repose::server {

/// A whole answer after which the connection is closed.
std::string print_last_reply(const Reply& reply);

/// The head of an answer that does not end.
std::string print_stream_head(const Reply& reply);

}  // namespace repose::server
