#include <optional>
#include <string>

#include "server/api/handlers.hpp"
#include "server/api/problem.hpp"
#include "server/api/query.hpp"
#include "server/api/reply.hpp"
#include "server/api/route.hpp"
#include "server/service.hpp"

namespace repose::server::handlers {

namespace {

bool wants_table(const Request& request) {
  return request.field("accept").find("text/csv") != std::string::npos;
}

constexpr const char* table_type = "text/csv; charset=utf-8; header=present";

}  // namespace

Reply list_measurement_sets(Service& service, const Request& request) {
  Query query(request);
  const auto limit = static_cast<int>(query.whole("limit", 1, largest_page).value_or(usual_page));
  const auto after = query.text("after");
  if (!query.problems().empty()) return query.refusal();
  return reply_of(service.measurement_sets(limit, after));
}

Reply get_measurement_set(Service& service, const Request& request) {
  Query query(request);
  const auto version = query.whole("version", 1);
  if (!query.problems().empty()) return query.refusal();
  const bool table = wants_table(request);
  Reply reply = reply_of(service.measurement_set(request.name, version, table));
  if (table && reply.status == 200) reply.content_type = table_type;
  return reply;
}

Reply put_measurement_set(Service& service, const Request& request) {
  Query query(request);
  auto material = query.text("material");
  if (!query.problems().empty()) return query.refusal();
  const bool table = media_type(request.content_type) == "text/csv";
  if (table && material.value_or("").empty()) {
    return problem_reply(
        400,
        "A table does not say what was measured.",
        {{"?material", "a table needs a material", "", "the name of what was measured"}});
  }
  if (!table) material.reset();
  return reply_of(service.put_measurement_set(request.name, request.body, material));
}

Reply list_fits(Service& service, const Request& request) {
  Query query(request);
  db::FitFilter filter;
  filter.material = query.text("material");
  filter.name = query.text("name");
  filter.before = query.whole("before", 1);
  auto limit = static_cast<int>(query.whole("limit", 1, largest_page).value_or(usual_page));
  const bool latest = query.truth("latest");
  if (!query.problems().empty()) return query.refusal();
  if (latest) limit = 1;
  return reply_of(service.fits(filter, limit));
}

}  // namespace repose::server::handlers
