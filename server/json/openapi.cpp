#include "server/json/openapi.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "server/json/catalogue_schema.hpp"
#include "server/json/schemas.hpp"
#include "server/letters.hpp"

namespace repose::server {

namespace {

constexpr std::string_view suffix = ".schema.json";
constexpr std::string_view components = "#/components/schemas/";
constexpr std::string_view definitions = "/definitions/";
constexpr std::string_view answers = "answers";  // whose definitions are components themselves

Json reference(std::string_view component) {
  return {{"$ref", std::string(components) + std::string(component)}};
}

/// Where a reference of one of our schemas, "FILE#/PLACE", leads within the one document.
std::string moved(std::string_view target, std::string_view component) {
  const std::size_t hash = std::min(target.find('#'), target.size());
  const std::string_view file = target.substr(0, hash);
  std::string_view place = target.substr(std::min(hash + 1, target.size()));
  if (!file.empty()) component = file.substr(0, file.size() - suffix.size());
  if (component == answers && place.starts_with(definitions)) {
    place.remove_prefix(definitions.size());
    return std::string(components) + std::string(place);
  }
  return std::string(components) + std::string(component) + std::string(place);
}

/// A schema as a component: without the identity of a file, its references moved.
void settle(Json& schema, std::string_view component) {
  if (schema.is_array()) {
    for (Json& element : schema) settle(element, component);
    return;
  }
  if (!schema.is_object()) return;
  for (const char* name : {"$schema", "$id", "$comment"}) schema.erase(name);
  for (const auto& [name, value] : schema.items()) {
    if (name == "$ref") {
      value = moved(value.get<std::string>(), component);
    } else {
      settle(value, component);
    }
  }
}

Json component_schemas() {
  Json result = Json::object();
  for (const auto& [file, text] : written_schemas()) {
    const std::string name = file.substr(0, file.size() - suffix.size());
    Json schema = Json::parse(text);
    settle(schema, name);
    if (name == answers) {
      for (const auto& [part, value] : schema["definitions"].items()) result[part] = value;
    } else {
      result[name] = std::move(schema);
    }
  }
  Json effects = effects_schema();
  settle(effects, "effects");
  result["effects"] = std::move(effects);
  Json experiments = experiments_schema();
  settle(experiments, "experiments");
  result["experiments"] = std::move(experiments);
  return result;
}

Json content(const char* type, Json schema) {
  return {{"content", {{type, {{"schema", std::move(schema)}}}}}};
}

/// A body that may also have other forms, which are texts.
void add_forms(Json& body, std::span<const std::string_view> also) {
  for (const std::string_view form : also) {
    body["content"][std::string(form)] = {{"schema", {{"type", "string"}}}};
  }
}

bool reads(const Route& route) { return route.method == "GET"; }

/// A field of the head that the protocol has for many routes, whatever they are about.
struct HeadField {
  std::string_view component;
  std::string_view name;
  std::string_view meaning;
  bool (*is_for)(const Route& route, std::span<const Route> routes);
};

constexpr std::array<HeadField, 5> head_fields{{
    {"IfNoneMatch",
     "If-None-Match",
     "the ETag of an earlier answer, or several: 304 and no body where it is still the same",
     [](const Route& route, std::span<const Route>) { return reads(route); }},
    {"LastEventId",
     "Last-Event-ID",
     "as ?after, and before it: what a client sends that was cut off",
     [](const Route& route, std::span<const Route>) {
       return std::ranges::count(route.also, "text/event-stream") > 0;
     }},
    {"IfMatch",
     "If-Match",
     "the ETag of what was read, in any of its forms: where that has changed nothing is done, and "
     "the answer is 412",
     [](const Route& route, std::span<const Route> routes) {
       return (route.method == "PUT" || route.method == "DELETE") &&
              std::ranges::any_of(routes, [&](const Route& other) {
                return reads(other) && other.pattern == route.pattern;
              });
     }},
    {"IdempotencyKey",
     "Idempotency-Key",
     "1 to 64 printable letters: the same request with the same key is done once within a day, and "
     "answered again as it was then, with Idempotency-Replayed: true",
     [](const Route& route, std::span<const Route>) { return !reads(route); }},
    {"RequestId",
     "X-Request-Id",
     "what the answer and the log call the request, 1 to 64 printable letters; else one is made up",
     [](const Route&, std::span<const Route>) { return true; }},
}};

Json parameter_reference(std::string_view component) {
  return {{"$ref", "#/components/parameters/" + std::string(component)}};
}

Json component_parameters() {
  Json result = Json::object();
  for (const HeadField& field : head_fields) {
    result[std::string(field.component)] = {{"name", field.name},
                                            {"in", "header"},
                                            {"description", field.meaning},
                                            {"schema", {{"type", "string"}}}};
  }
  return result;
}

constexpr const char* security_scheme = "token";

Json component_security() {
  return {{security_scheme,
           {{"type", "http"},
            {"scheme", "bearer"},
            {"description",
             "As `repose token create` prints it. A service without tokens asks for none."}}}};
}

/// The scope that a token must give; nothing where anyone may.
Json print_security(const Route& route) {
  const Scope needed = needed_scope(route);
  if (needed == Scope::nothing) return Json::array();
  const auto scope = scope_names.at(static_cast<std::size_t>(needed));
  return Json::array({Json{{security_scheme, Json::array({scope})}}});
}

/// What may stand in a field of the query.
Json print_field(const QueryField& field) {
  if (field.kind == QueryField::Kind::text) return {{"type", "string"}};
  if (field.kind == QueryField::Kind::truth) return {{"type", "boolean"}};
  Json schema{{"type", "integer"}, {"minimum", field.least}};
  if (field.most < QueryField{}.most) schema["maximum"] = field.most;
  return schema;
}

Json print_parameters(const Route& route, std::span<const Route> routes) {
  Json result = Json::array();
  if (route.pattern.find("{id}") != std::string_view::npos) {
    result.push_back(
        {{"name", "id"}, {"in", "path"}, {"required", true}, {"schema", print_field({})}});
  }
  if (route.pattern.find("{name}") != std::string_view::npos) {
    Json schema{{"type", "string"}, {"minLength", 1}};
    if (!route.names.empty()) schema = {{"enum", route.names}};
    result.push_back(
        {{"name", "name"}, {"in", "path"}, {"required", true}, {"schema", std::move(schema)}});
  }
  for (const QueryField& field : route.query) {
    result.push_back({{"name", field.name},
                      {"in", "query"},
                      {"description", field.meaning},
                      {"schema", print_field(field)}});
  }
  for (const HeadField& field : head_fields) {
    if (field.is_for(route, routes)) result.push_back(parameter_reference(field.component));
  }
  return result;
}

Json print_operation(const Route& route, std::span<const Route> routes) {
  Json operation{{"operationId", route.name},
                 {"summary", route.summary},
                 {"security", print_security(route)},
                 {"parameters", print_parameters(route, routes)}};
  if (!route.request.empty()) {
    operation["requestBody"] = content("application/json", reference(route.request));
    operation["requestBody"]["required"] = true;
    add_forms(operation["requestBody"], route.also);
  }
  const bool is_json = route.media == "application/json";
  Json success = content(std::string(route.media).c_str(),
                         !is_json                 ? Json{{"type", "string"}}
                         : route.response.empty() ? Json{{"type", "object"}}
                                                  : reference(route.response));
  add_forms(success, route.also);
  success["description"] = "The answer.";
  if (route.success == 202) success["description"] = "Taken on; the answer says how it stands.";
  if (reads(route)) {
    success["headers"]["ETag"] = {{"description", "Of this body; a stream has none."},
                                  {"schema", {{"type", "string"}}}};
  }
  Json problem = content("application/problem+json", reference("problem"));
  problem["description"] = "What went wrong.";
  Json& responses = operation["responses"];
  responses[std::to_string(route.success)] = std::move(success);
  if (reads(route)) {
    responses["304"] = {{"description", "What the client has, by If-None-Match, is still so."}};
  }
  responses["4XX"] = problem;
  responses["5XX"] = std::move(problem);
  return operation;
}

}  // namespace

std::string print_openapi(std::span<const Route> routes) {
  Json paths = Json::object();
  for (const Route& route : routes) {
    paths[std::string(route.pattern)][lower_case(route.method)] = print_operation(route, routes);
  }
  return to_text(
      Json{{"openapi", "3.1.0"},
           {"info",
            {{"title", "repose"},
             {"description",
              "Calibrates the parameters of grains in discrete element models. Generated from the "
              "route table by `repose schema`: do not edit."},
             {"version", "1"}}},
           {"paths", std::move(paths)},
           {"components",
            {{"securitySchemes", component_security()},
             {"parameters", component_parameters()},
             {"schemas", component_schemas()}}}},
      2);
}

}  // namespace repose::server
