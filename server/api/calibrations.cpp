#include <optional>
#include <string>

#include "server/api/handlers.hpp"
#include "server/api/query.hpp"
#include "server/api/reply.hpp"

namespace repose::server::handlers {

Reply submit_calibration(Service& service, const Request& request) {
  return accepted(service.submit(request.body), "/v1/calibrations");
}

Reply list_calibrations(Service& service, const Request& request) {
  Query query(request);
  const auto limit = static_cast<int>(query.whole("limit", 1, largest_page).value_or(usual_page));
  const auto before = query.whole("before", 1);
  if (!query.problems().empty()) return query.refusal();
  return reply_of(service.calibrations(limit, before));
}

Reply get_calibration(Service& service, const Request& request) {
  const auto answer = service.calibration(request.id);
  Reply reply = reply_of(answer, 200);
  // A member of that name is there once; within a text its quotes would be escaped.
  if (answer && answer->find("\"finished_at\":null") != std::string::npos) {
    reply.headers.emplace_back("Retry-After", "1");
  }
  return reply;
}

Reply list_evaluations(Service& service, const Request& request) {
  Query query(request);
  const auto limit = static_cast<int>(query.whole("limit", 1, largest_page).value_or(usual_page));
  const auto after = query.whole("after", 0);
  if (!query.problems().empty()) return query.refusal();
  return reply_of(service.evaluations(request.id, limit, after));
}

Reply cancel_calibration(Service& service, const Request& request) {
  return reply_of(service.cancel(request.id), 202);
}

/// Input files of other codes are text; JSON and CSV have types of their own.
Reply export_fit(Service& service, const Request& request) {
  Reply reply = reply_of(service.export_fit(request.id, request.name), 200);
  if (reply.status != 200) return reply;
  if (request.name == "csv")
    reply.content_type = "text/csv; charset=utf-8; header=present";
  else if (request.name != "json")
    reply.content_type = "text/plain; charset=utf-8";
  return reply;
}

Reply list_best_fits(Service& service, const Request& request) {
  Query query(request);
  const db::FitFilter filter{.material = query.text("material"), .name = query.text("name")};
  if (!query.problems().empty()) return query.refusal();
  return {.status = 200, .body = service.best_fits(filter)};
}

}  // namespace repose::server::handlers
