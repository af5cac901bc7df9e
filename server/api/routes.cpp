#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <system_error>
#include <utility>

#include "server/api/handlers.hpp"
#include "server/api/problem.hpp"
#include "server/api/query.hpp"
#include "server/api/route.hpp"
#include "server/exports/export.hpp"
#include "server/letters.hpp"

namespace repose::server {

namespace {

using Kind = QueryField::Kind;

constexpr QueryField limit_field{
    "limit", "of a page, how many items (50 where it is not given)", Kind::whole, 1, largest_page};
constexpr std::array<QueryField, 2> list_fields{{
    limit_field,
    {"before", "only items older than this one: the answer's `next`"},
}};
constexpr std::array<QueryField, 2> evaluation_fields{{
    limit_field,
    {"after", "only items after this one: the answer's `next`", Kind::whole, 0},
}};
constexpr std::array<QueryField, 2> event_fields{{
    {"after",
     "only events after this one (Last-Event-ID, where it is given, before this)",
     Kind::whole,
     0},
    limit_field,
}};
constexpr std::array<QueryField, 5> fit_fields{{
    {"material", "only of that material", Kind::text},
    {"name", "only of the study of that name", Kind::text},
    {"latest", "true: only the newest one", Kind::truth},
    limit_field,
    {"before", "only items older than this one: the answer's `next`"},
}};
constexpr std::array<QueryField, 2> set_list_fields{{
    limit_field,
    {"after", "only names after this one: the answer's `next`", Kind::text},
}};
constexpr std::array<QueryField, 1> version_field{{{"version", "which; else the newest"}}};
constexpr std::array<QueryField, 1> table_fields{
    {{"material", "what was measured, where a table is sent", Kind::text}}};
constexpr std::array<QueryField, 2> best_fit_fields{{
    {"material", "only of that material", Kind::text},
    {"name", "only of the study of that name", Kind::text},
}};

constexpr std::string_view json = "application/json";
constexpr std::array<std::string_view, 1> stream{"text/event-stream"}, table_form{"text/csv"};
constexpr std::array<std::string_view, 2> export_forms{"text/csv", "text/plain"};

// clang-format off
constexpr std::array<Route, 43> table{{
    {"POST", "/v1/calibrations", "submitCalibration", "Queue a calibration.",
     "submission", 202, "calibration_document", {}, handlers::submit_calibration},
    {"GET", "/v1/calibrations", "listCalibrations", "List calibrations, newest first.",
     "", 200, "calibration_list", list_fields, handlers::list_calibrations},
    {"GET", "/v1/calibrations/{id}", "getCalibration", "Get a calibration: study, state, progress, fit.",
     "", 200, "calibration_document", {}, handlers::get_calibration},
    {"GET", "/v1/calibrations/{id}/evaluations", "listEvaluations", "List its evaluations in the order of work.",
     "", 200, "evaluation_list", evaluation_fields, handlers::list_evaluations},
    {"GET", "/v1/calibrations/{id}/exports/{name}", "exportFit", "Get the fit as json, csv, or input of liggghts, lammps, yade.",
     "", 200, "", {}, handlers::export_fit, json, {}, export_forms, export_format_names},
    {"DELETE", "/v1/calibrations/{id}", "cancelCalibration", "Cancel a calibration that is not finished.",
     "", 202, "calibration_document", {}, handlers::cancel_calibration},
    {"GET", "/v1/calibrations/{id}/events", "followCalibration", "Follow a calibration: a stream of events, or a page of them.",
     "", 200, "event_list", event_fields, handlers::follow_calibration, json, {}, stream},
    {"GET", "/v1/events", "followAll", "Follow everything: a stream of events, or a page of them.",
     "", 200, "event_list", event_fields, handlers::follow_all, json, {}, stream},
    {"GET", "/v1/measurement-sets", "listMeasurementSets", "List the sets of measurements that are kept.",
     "", 200, "measurement_set_list", set_list_fields, handlers::list_measurement_sets},
    {"GET", "/v1/measurement-sets/{name}", "getMeasurementSet", "Get a set of measurements, as JSON or CSV.",
     "", 200, "measurement_set", version_field, handlers::get_measurement_set, json, {}, table_form},
    {"PUT", "/v1/measurement-sets/{name}", "putMeasurementSet", "Keep a new version of a set, sent as JSON or CSV.",
     "measurement_set_content", 200, "measurement_set", table_fields, handlers::put_measurement_set, json, {}, table_form},
    {"GET", "/v1/fits", "listFits", "Get fits with their intervals, how well they meet their measurements, and where they are from.",
     "", 200, "fit_list", fit_fields, handlers::list_fits},
    {"GET", "/v1/calibrations/{id}/comparison", "getComparison", "Compare a finished calibration with its measurements.",
     "", 200, "comparison", {}, handlers::get_comparison},
    {"POST", "/v1/calibrations/{id}/diagnoses", "submitDiagnosis", "Queue a diagnosis: which effect its model lacks.",
     "diagnosis_request", 202, "diagnosis_document", {}, handlers::submit_diagnosis},
    {"GET", "/v1/calibrations/{id}/diagnoses", "listDiagnoses", "List its diagnoses, newest first.",
     "", 200, "diagnosis_list", {}, handlers::list_diagnoses},
    {"POST", "/v1/calibrations/{id}/extensions", "extendCalibration", "Queue the calibration that adds an effect to its model.",
     "extension_request", 202, "calibration_document", {}, handlers::extend_calibration},
    {"GET", "/v1/calibrations/{id}/lineage", "getLineage", "Get the calibrations that add effects to one another.",
     "", 200, "lineage", {}, handlers::get_lineage},
    {"GET", "/v1/diagnoses/{id}", "getDiagnosis", "Get a diagnosis: state, progress, result.",
     "", 200, "diagnosis_document", {}, handlers::get_diagnosis},
    {"DELETE", "/v1/diagnoses/{id}", "cancelDiagnosis", "Cancel a diagnosis that is not finished.",
     "", 202, "diagnosis_document", {}, handlers::cancel_diagnosis},
    {"GET", "/v1/best-fits", "listBestFits", "Get the best fit of every study and material: the smallest misfit.",
     "", 200, "best_fit_list", best_fit_fields, handlers::list_best_fits},
    {"GET", "/v1/catalogue", "getCatalogue", "Get effects, experiments, material properties and units.",
     "", 200, "catalogue", {}, handlers::get_catalogue},
    {"GET", "/v1/materials", "listMaterials", "List the grains that are described: published ones, and those of users.",
     "", 200, "material_list", {}, handlers::list_materials},
    {"GET", "/v1/materials/{name}", "getMaterial", "Get the properties of a grain: published, with their sources, or a user's.",
     "", 200, "material", {}, handlers::get_material},
    {"PUT", "/v1/materials/{name}", "putMaterial", "Describe a grain of your own.",
     "material_content", 200, "material", {}, handlers::put_material},
    {"DELETE", "/v1/materials/{name}", "removeMaterial", "Remove a grain of your own.",
     "", 200, "material", {}, handlers::remove_material},
    {"POST", "/v1/schedules", "addSchedule", "Have a study calibrated again at its times.",
     "schedule", 201, "schedule_document", {}, handlers::add_schedule},
    {"GET", "/v1/schedules", "listSchedules", "List the schedules.",
     "", 200, "schedule_list", {}, handlers::list_schedules},
    {"GET", "/v1/schedules/{id}", "getSchedule", "Get a schedule: when next, what the last night came to, the fit in force.",
     "", 200, "schedule_document", {}, handlers::get_schedule},
    {"PUT", "/v1/schedules/{id}", "replaceSchedule", "Put another schedule in its place: new measurements, for instance.",
     "schedule", 200, "schedule_document", {}, handlers::replace_schedule},
    {"DELETE", "/v1/schedules/{id}", "removeSchedule", "Begin no more nights; the history stays.",
     "", 200, "schedule_document", {}, handlers::remove_schedule},
    {"GET", "/v1/schedules/{id}/nights", "listNights", "List its nights, newest first.",
     "", 200, "night_list", list_fields, handlers::list_nights},
    {"GET", "/v1/schedules/{id}/promotions", "listPromotions", "List which fit was in force from when on, newest first.",
     "", 200, "promotion_list", {}, handlers::list_promotions},
    {"POST", "/v1/schedules/{id}/promotions", "promote", "Put a fit of the schedule in force by hand: a candidate, or an earlier one.",
     "promotion", 200, "schedule_document", {}, handlers::promote},
    {"POST", "/v1/webhooks", "addWebhook", "Have an address told of events; the answer shows the secret, this once.",
     "webhook", 201, "webhook_document", {}, handlers::add_webhook, json, Scope::admin},
    {"GET", "/v1/webhooks", "listWebhooks", "List the addresses that are told.",
     "", 200, "webhook_list", {}, handlers::list_webhooks, json, Scope::admin},
    {"GET", "/v1/webhooks/{id}", "getWebhook", "Get a webhook: what has arrived, what failed last, when it is tried again.",
     "", 200, "webhook_document", {}, handlers::get_webhook, json, Scope::admin},
    {"PUT", "/v1/webhooks/{id}", "replaceWebhook", "Change a webhook, or put a parked one in force again where it was.",
     "webhook", 200, "webhook_document", {}, handlers::replace_webhook, json, Scope::admin},
    {"DELETE", "/v1/webhooks/{id}", "removeWebhook", "Tell that address nothing more.",
     "", 200, "webhook_document", {}, handlers::remove_webhook, json, Scope::admin},
    {"GET", "/v1/openapi.json", "getDescription", "Get this description.",
     "", 200, "", {}, handlers::get_openapi},
    {"GET", "/healthz", "getHealth", "See whether the service can work.",
     "", 200, "health", {}, handlers::get_health},
    {"GET", "/readyz", "getReadiness", "See whether the service can take on work.",
     "", 200, "readiness", {}, handlers::get_readiness, json, Scope::nothing},
    {"GET", "/metrics", "getMetrics", "Get figures for Prometheus.",
     "", 200, "", {}, handlers::get_metrics, "text/plain"},
    {"GET", "/livez", "getLife", "See whether the process answers.",
     "", 200, "life", {}, handlers::get_life, json, Scope::nothing},
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

}  // namespace

std::string media_type(std::string_view content_type) {
  return lower_case(trimmed(content_type.substr(0, content_type.find(';'))));
}

std::span<const Route> routes() { return table; }

Scope needed_scope(const Route& route) {
  if (route.scope) return *route.scope;
  return route.method == "GET" ? Scope::read : Scope::submit;
}

engine::Result<const Route*, Reply> find_route(Request& request) {
  const std::string_view asked = request.method;
  const std::string_view method = asked == "HEAD" ? "GET" : asked;
  std::string allowed;
  for (const Route& route : table) {
    auto parts = match(route.pattern, request.path);
    if (!parts) continue;
    if (route.method == method) {
      request.id = parts->id;
      request.name = std::move(parts->name);
      return &route;
    }
    allowed += (allowed.empty() ? "" : ", ") + std::string(route.method);
    if (route.method == "GET") allowed += ", HEAD";
  }
  if (allowed.empty()) {
    return engine::Unexpected{problem_reply(404, "There is nothing at this address.")};
  }
  Reply reply = problem_reply(405, "Allowed here: " + allowed + ".");
  reply.headers.emplace_back("Allow", allowed);
  return engine::Unexpected{std::move(reply)};
}

Reply run_route(const Route& route, Service& service, const Request& request) {
  const std::string type = media_type(request.content_type);
  if (!route.request.empty() && type != json &&
      std::ranges::find(route.also, type) == route.also.end()) {
    std::string forms(json);
    for (const std::string_view form : route.also) forms += " or " + std::string(form);
    return problem_reply(415, "Send the document as Content-Type: " + forms + ".");
  }
  Problems problems = unknown_fields(request, route);
  if (!problems.empty()) return problem_reply(400, "The query has problems.", std::move(problems));
  return route.handler(service, request);
}

Reply respond(Service& service, Request request) {
  const auto route = find_route(request);
  return route ? run_route(**route, service, request) : route.error();
}

}  // namespace repose::server
