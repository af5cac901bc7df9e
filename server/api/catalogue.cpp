#include "server/api/handlers.hpp"
#include "server/json/catalogue_json.hpp"
#include "server/json/openapi.hpp"

namespace repose::server::handlers {

// Neither changes while the program runs.

Reply get_catalogue(Service& /*service*/, const Request& /*request*/) {
  static const std::string document = print_catalogue();
  return {.status = 200, .body = document};
}

Reply get_openapi(Service& /*service*/, const Request& /*request*/) {
  static const std::string document = print_openapi(routes());
  return {.status = 200, .body = document};
}

}  // namespace repose::server::handlers
