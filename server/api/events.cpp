#include <optional>
#include <string>

#include "server/api/handlers.hpp"
#include "server/api/problem.hpp"
#include "server/api/query.hpp"
#include "server/api/reply.hpp"
#include "server/service.hpp"

namespace repose::server::handlers {

namespace {

/// Streams are for those who do not say that they want a page.
bool wants_page(const Request& request) {
  const std::string accepted = request.field("accept");
  return accepted.find("application/json") != std::string::npos &&
         accepted.find("text/event-stream") == std::string::npos;
}

/// The events of a calibration begin with its first one, those of all with the next one.
Reply follow(const Service& service,
             const Request& request,
             const std::optional<std::int64_t>& calibration) {
  Query query(request);
  const auto limit = static_cast<int>(query.whole("limit", 1, largest_page).value_or(usual_page));
  const auto asked = query.whole("after", 0);
  const auto last = query.whole_field("last-event-id", 0);
  if (!query.problems().empty()) return query.refusal();
  auto after = last ? last : asked;  // a client that comes again keeps its first address
  if (wants_page(request)) {
    return reply_of(service.events(calibration, limit, after.value_or(0)));
  }
  if (!after && calibration) after = 0;
  auto source = service.event_stream(calibration, after);
  if (!source) return problem_reply(source.error());
  return {.status = 200,
          .body = "retry: 2000\n\n",  // ms after which a client that was cut off comes again
          .content_type = "text/event-stream",
          .stream = *std::move(source)};
}

}  // namespace

Reply follow_calibration(Service& service, const Request& request) {
  return follow(service, request, request.id);
}

Reply follow_all(Service& service, const Request& request) {
  return follow(service, request, std::nullopt);
}

}  // namespace repose::server::handlers
