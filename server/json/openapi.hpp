/// OpenAPI 3.1 document of the API, printed from the route table and the schemas.
#pragma once

#include <span>
#include <string>

#include "server/api/route.hpp"

namespace repose::server {

std::string print_openapi(std::span<const Route> routes);

}  // namespace repose::server
