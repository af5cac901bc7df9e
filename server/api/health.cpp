#include "server/api/api.hpp"
#include "server/api/handlers.hpp"
#include "server/api/metrics.hpp"
#include "server/api/problem.hpp"
#include "server/service.hpp"

namespace repose::server::handlers {

Reply get_health(Service& service, const Request& /*request*/) {
  return {.status = 200, .body = service.health()};
}

/// Says no more than that: whoever asks has no token.
Reply get_readiness(Service& service, const Request& /*request*/) {
  if (service.ready()) return {.status = 200, .body = R"({"status":"ready"})"};
  Reply reply = problem_reply(503, "The service cannot write its store; its log says why.");
  reply.headers.emplace_back("Retry-After", "10");
  return reply;
}

Reply get_metrics(Service& service, const Request& request) {
  std::string page =
      request.api == nullptr ? Metrics().print(service.figures(), {}) : request.api->metrics();
  return {.status = 200, .body = std::move(page), .content_type = "text/plain; version=0.0.4"};
}

/// Says only that the process answers.
Reply get_life(Service& /*service*/, const Request& /*request*/) {
  return {.status = 200, .body = R"({"status":"ok"})"};
}

}  // namespace repose::server::handlers
