#include <string>

#include "server/api/handlers.hpp"
#include "server/api/problem.hpp"
#include "server/json/text.hpp"
#include "server/service.hpp"

namespace repose::server::handlers {

namespace {

Reply reply_of(const Answer<std::string>& answer, int status = 200) {
  if (!answer) return problem_reply(answer.error());
  return {.status = status, .body = *answer};
}

}  // namespace

Reply add_webhook(Service& service, const Request& request) {
  const auto answer = service.add_webhook(request.body);
  Reply reply = reply_of(answer, 201);
  if (!answer) return reply;
  if (const auto id = whole_member(*answer, "id")) {
    reply.headers.emplace_back("Location", "/v1/webhooks/" + std::to_string(*id));
  }
  return reply;
}

Reply list_webhooks(Service& service, const Request& /*request*/) {
  return {.status = 200, .body = service.webhooks()};
}

Reply get_webhook(Service& service, const Request& request) {
  return reply_of(service.webhook(request.id));
}

Reply replace_webhook(Service& service, const Request& request) {
  return reply_of(service.replace_webhook(request.id, request.body));
}

Reply remove_webhook(Service& service, const Request& request) {
  return reply_of(service.remove_webhook(request.id));
}

}  // namespace repose::server::handlers
