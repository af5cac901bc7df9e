/// The address of the page that follows a list's, for the field Link (RFC 8288).
#pragma once

#include <string>

#include "server/api/route.hpp"

namespace repose::server {

/// Of a list's body, which ends with its member "next"; empty where no page follows, or where the
/// route has no field of the query for one.
std::string next_page(const Route& route, const Request& request, const std::string& body);

}  // namespace repose::server
