/// A reply <-> the document that the store keeps of it.
#pragma once

#include <string>
#include <string_view>

#include "server/api/route.hpp"

namespace repose::server {

std::string print_reply(const Reply& reply);

/// Of a text that print_reply() has written.
Reply read_reply(std::string_view text);

}  // namespace repose::server
