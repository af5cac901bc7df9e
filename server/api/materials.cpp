#include "server/api/handlers.hpp"
#include "server/api/problem.hpp"
#include "server/json/material_library.hpp"

namespace repose::server::handlers {

Reply list_materials(Service& /*service*/, const Request& /*request*/) {
  return {.status = 200, .body = print_material_list()};
}

Reply get_material(Service& /*service*/, const Request& request) {
  if (find_material(request.name) == nullptr) {
    return problem_reply(404, no_such_material(request.name));
  }
  return {.status = 200, .body = print_material(request.name)};
}

}  // namespace repose::server::handlers
