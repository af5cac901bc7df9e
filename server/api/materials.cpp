#include "server/api/handlers.hpp"
#include "server/api/reply.hpp"
#include "server/service.hpp"

namespace repose::server::handlers {

Reply list_materials(Service& service, const Request& /*request*/) {
  return {.status = 200, .body = service.materials()};
}

Reply get_material(Service& service, const Request& request) {
  return reply_of(service.material(request.name));
}

Reply put_material(Service& service, const Request& request) {
  // That it is the one that the client knows has been looked at before this is called.
  const bool names_it = !request.field("if-match").empty();
  return reply_of(service.put_material(request.name, request.body, names_it));
}

Reply remove_material(Service& service, const Request& request) {
  return reply_of(service.remove_material(request.name));
}

}  // namespace repose::server::handlers
