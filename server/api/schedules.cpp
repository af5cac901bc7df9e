#include "server/api/handlers.hpp"
#include "server/api/query.hpp"
#include "server/api/reply.hpp"
#include "server/service.hpp"

namespace repose::server::handlers {

Reply add_schedule(Service& service, const Request& request) {
  return created(service.add_schedule(request.body), "/v1/schedules");
}

Reply list_schedules(Service& service, const Request& /*request*/) {
  return {.status = 200, .body = service.schedules()};
}

Reply get_schedule(Service& service, const Request& request) {
  return reply_of(service.schedule(request.id));
}

Reply replace_schedule(Service& service, const Request& request) {
  return reply_of(service.replace_schedule(request.id, request.body));
}

Reply remove_schedule(Service& service, const Request& request) {
  return reply_of(service.remove_schedule(request.id));
}

Reply list_nights(Service& service, const Request& request) {
  Query query(request);
  const auto limit = static_cast<int>(query.whole("limit", 1, largest_page).value_or(usual_page));
  const auto before = query.whole("before", 1);
  if (!query.problems().empty()) return query.refusal();
  return reply_of(service.nights(request.id, limit, before));
}

Reply list_promotions(Service& service, const Request& request) {
  return reply_of(service.promotions(request.id));
}

Reply promote(Service& service, const Request& request) {
  return reply_of(service.promote(request.id, request.body));
}

}  // namespace repose::server::handlers
