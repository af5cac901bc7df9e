#include "server/api/handlers.hpp"
#include "server/api/reply.hpp"
#include "server/service.hpp"

namespace repose::server::handlers {

Reply add_webhook(Service& service, const Request& request) {
  return created(service.add_webhook(request.body), "/v1/webhooks");
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
