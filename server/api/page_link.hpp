/// The address of the page that follows a list's, for the field Link (RFC 8288).
#pragma once

#include <string>

#include "server/api/route.hpp"

namespace repose::server {

/// `cursor`: where that page begins. Empty without one, or where the route has no field of the
/// query for it.
std::string next_page(const Route& route, const Request& request, const std::string& cursor);

/// The query as one text, equal where the fields and their values are: "a=1&b=2", by their names.
std::string print_query(const Request& request);

}  // namespace repose::server
