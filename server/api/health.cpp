#include "server/api/handlers.hpp"
#include "server/service.hpp"

namespace repose::server::handlers {

Reply get_health(Service& service, const Request& /*request*/) {
  return {.status = 200, .body = service.health()};
}

/// Says only that the process answers.
Reply get_life(Service& /*service*/, const Request& /*request*/) {
  return {.status = 200, .body = R"({"status":"ok"})"};
}

}  // namespace repose::server::handlers
