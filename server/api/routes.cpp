#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <system_error>

#include "server/api/handlers.hpp"
#include "server/api/problem.hpp"
#include "server/api/query.hpp"
#include "server/api/route.hpp"

namespace repose::server {

namespace {

constexpr std::array<QueryField, 2> list_fields{{
    {"limit", "how many items, 1 to 200 (50 where it is not given)"},
    {"before", "only items older than this one: the answer's `next`"},
}};
constexpr std::array<QueryField, 2> evaluation_fields{{
    {"limit", "how many items, 1 to 200 (50 where it is not given)"},
    {"after", "only items after this one: the answer's `next`", true, 0},
}};
constexpr std::array<QueryField, 1> best_fit_fields{
    {{"name", "only of the study of that name", false}}};

// clang-format off
constexpr std::array<Route, 12> table{{
    {"POST", "/v1/calibrations", "submitCalibration", "Queue a calibration.",
     "calibration", 202, "calibration_document", {}, handlers::submit_calibration},
    {"GET", "/v1/calibrations", "listCalibrations", "List calibrations, newest first.",
     "", 200, "calibration_list", list_fields, handlers::list_calibrations},
    {"GET", "/v1/calibrations/{id}", "getCalibration", "Get a calibration: study, state, progress, fit.",
     "", 200, "calibration_document", {}, handlers::get_calibration},
    {"GET", "/v1/calibrations/{id}/evaluations", "listEvaluations", "List its evaluations in the order of work.",
     "", 200, "evaluation_list", evaluation_fields, handlers::list_evaluations},
    {"DELETE", "/v1/calibrations/{id}", "cancelCalibration", "Cancel a calibration that is not finished.",
     "", 202, "calibration_document", {}, handlers::cancel_calibration},
    {"GET", "/v1/best-fits", "listBestFits", "Get the best fit of every study, or of one.",
     "", 200, "best_fit_list", best_fit_fields, handlers::list_best_fits},
    {"GET", "/v1/catalogue", "getCatalogue", "Get effects, experiments, material properties and units.",
     "", 200, "catalogue", {}, handlers::get_catalogue},
    {"GET", "/v1/materials", "listMaterials", "List the grains of which published properties are known.",
     "", 200, "material_list", {}, handlers::list_materials},
    {"GET", "/v1/materials/{name}", "getMaterial", "Get the published properties of a grain, with their sources.",
     "", 200, "published_material", {}, handlers::get_material},
    {"GET", "/v1/openapi.json", "getDescription", "Get this description.",
     "", 200, "", {}, handlers::get_openapi},
    {"GET", "/healthz", "getHealth", "See whether the service can work.",
     "", 200, "health", {}, handlers::get_health},
    {"GET", "/livez", "getLife", "See whether the process answers.",
     "", 200, "life", {}, handlers::get_life},
}};
// clang-format on

/// Takes the first segment off a path.
std::string_view next_segment(std::string_view& path) {
  const std::size_t end = std::min(path.find('/'), path.size());
  const std::string_view segment = path.substr(0, end);
  path.remove_prefix(std::min(end + 1, path.size()));
  return segment;
}

std::optional<std::int64_t> id_of(std::string_view segment) {
  std::int64_t value = 0;
  const auto result = std::from_chars(segment.data(), segment.data() + segment.size(), value);
  const bool whole = result.ec == std::errc{} && result.ptr == segment.data() + segment.size();
  if (!whole || value < 1) return std::nullopt;
  return value;
}

/// What a path says in the places that its pattern leaves open.
struct PathParts {
  std::int64_t id = 0;
  std::string name;
};

/// The parts of a path that has the pattern's form; else nothing.
std::optional<PathParts> match(std::string_view pattern, std::string_view path) {
  if (std::ranges::count(pattern, '/') != std::ranges::count(path, '/')) return std::nullopt;
  PathParts parts;
  while (!pattern.empty() || !path.empty()) {
    const std::string_view expected = next_segment(pattern);
    const std::string_view found = next_segment(path);
    if (expected == "{id}") {
      const auto number = id_of(found);
      if (!number) return std::nullopt;
      parts.id = *number;
    } else if (expected == "{name}") {
      if (found.empty()) return std::nullopt;
      parts.name = found;
    } else if (expected != found) {
      return std::nullopt;
    }
  }
  return parts;
}

bool is_json(std::string_view content_type) {
  std::string type(content_type.substr(0, content_type.find(';')));
  while (!type.empty() && type.back() == ' ') type.pop_back();
  std::ranges::transform(type, type.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  });
  return type == "application/json";
}

Reply run(const Route& route, Service& service, const Request& request) {
  if (!route.request.empty() && !is_json(request.content_type)) {
    return problem_reply(415, "Send the document as Content-Type: application/json.");
  }
  Problems problems = unknown_fields(request, route);
  if (!problems.empty()) return problem_reply(400, "The query has problems.", std::move(problems));
  return route.handler(service, request);
}

}  // namespace

std::span<const Route> routes() { return table; }

Reply respond(Service& service, Request request) {
  const std::string_view asked = request.method;
  const std::string_view method = asked == "HEAD" ? "GET" : asked;
  std::string allowed;
  for (const Route& route : table) {
    const auto parts = match(route.pattern, request.path);
    if (!parts) continue;
    if (route.method == method) {
      request.id = parts->id;
      request.name = parts->name;
      return run(route, service, request);
    }
    allowed += (allowed.empty() ? "" : ", ") + std::string(route.method);
    if (route.method == "GET") allowed += ", HEAD";
  }
  if (allowed.empty()) return problem_reply(404, "There is nothing at this address.");
  Reply reply = problem_reply(405, "Allowed here: " + allowed + ".");
  reply.headers.emplace_back("Allow", allowed);
  return reply;
}

}  // namespace repose::server
