#include "server/json/openapi.hpp"

#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "server/json/text.hpp"

namespace {

using repose::server::Json;

const Json& description() {
  static const Json json = Json::parse(repose::server::print_openapi(repose::server::routes()));
  return json;
}

void collect_references(const Json& json, std::set<std::string>& into) {
  for (const auto& [name, value] : json.items()) {
    if (json.is_object() && name == "$ref") into.insert(value.get<std::string>());
    if (value.is_structured()) collect_references(value, into);
  }
}

const Json& operation(const std::string& method, const std::string& path) {
  return description()["paths"][path][method];
}

/// The names of all members below, references followed.
std::set<std::string> members_below(const Json& json, std::set<std::string>& seen) {
  std::set<std::string> names;
  for (const auto& [name, value] : json.items()) {
    if (json.is_object()) names.insert(name);
    if (json.is_object() && name == "$ref" && value.is_string()) {
      const auto reference = value.get<std::string>();
      if (!seen.insert(reference).second) continue;
      names.merge(members_below(description().at(Json::json_pointer(reference.substr(1))), seen));
    }
    if (value.is_structured()) names.merge(members_below(value, seen));
  }
  return names;
}

/// The names of the fields of the head that an operation is described with.
std::set<std::string> head_fields(const std::string& method, const std::string& path) {
  std::set<std::string> names;
  for (const Json& parameter : operation(method, path)["parameters"]) {
    if (!parameter.contains("$ref")) continue;
    const auto reference = parameter["$ref"].get<std::string>();
    const Json& field = description().at(Json::json_pointer(reference.substr(1)));
    CHECK(field["in"] == "header");
    names.insert(field["name"].get<std::string>());
  }
  return names;
}

}  // namespace

TEST_CASE("every route is described, with its body, its answer and its problems", "[server]") {
  for (const repose::server::Route& route : repose::server::routes()) {
    std::string method(route.method);
    for (char& letter : method) letter = static_cast<char>(letter - 'A' + 'a');
    const Json& operation = description()["paths"][std::string(route.pattern)][method];
    CHECK(operation["operationId"] == route.name);
    CHECK(operation.contains("requestBody") == !route.request.empty());
    CHECK(operation["responses"].contains(std::to_string(route.success)));
    CHECK(operation["responses"].contains("4XX"));
  }
}

TEST_CASE("every reference of the description leads somewhere within it", "[server]") {
  std::set<std::string> references;
  collect_references(description(), references);
  CHECK(references.size() > 10);
  for (const std::string& reference : references) {
    INFO(reference);
    REQUIRE(reference.starts_with("#/"));
    CHECK(description().contains(Json::json_pointer(reference.substr(1))));
  }
}

TEST_CASE("the schemas of requests hold no regular expression", "[server]") {
  for (const auto& [path, methods] : description()["paths"].items()) {
    for (const auto& [method, operation] : methods.items()) {
      if (!operation.contains("requestBody")) continue;
      INFO(method << " " << path);
      std::set<std::string> seen;
      const auto members = members_below(operation["requestBody"], seen);
      CHECK(members.contains("type"));
      CHECK_FALSE(members.contains("pattern"));
    }
  }
}

TEST_CASE("every route says which token it needs", "[server]") {
  CHECK(description()["components"]["securitySchemes"]["token"]["scheme"] == "bearer");
  CHECK(operation("get", "/v1/calibrations")["security"] == Json::parse(R"([{"token":["read"]}])"));
  CHECK(operation("post", "/v1/calibrations")["security"] ==
        Json::parse(R"([{"token":["submit"]}])"));
  CHECK(operation("post", "/v1/webhooks")["security"] == Json::parse(R"([{"token":["admin"]}])"));
  CHECK(operation("get", "/livez")["security"] == Json::array());
}

TEST_CASE("a route says what its fields may be, and every form of its answer", "[server]") {
  const auto schema_of = [](const std::string& path, const std::string& name) {
    for (const Json& parameter : operation("get", path)["parameters"]) {
      if (parameter.value("name", "") == name) return parameter["schema"];
    }
    return Json();
  };
  CHECK(schema_of("/v1/fits", "limit") ==
        Json{{"type", "integer"}, {"minimum", 1}, {"maximum", 200}});
  CHECK(schema_of("/v1/fits", "before") == Json{{"type", "integer"}, {"minimum", 1}});
  CHECK(schema_of("/v1/fits", "latest") == Json{{"type", "boolean"}});
  const std::string exports = "/v1/calibrations/{id}/exports/{name}";
  CHECK(schema_of(exports, "name") ==
        Json{{"enum", {"json", "csv", "liggghts", "lammps", "yade"}}});
  std::set<std::string> forms;
  for (const auto& [form, _] : operation("get", exports)["responses"]["200"]["content"].items()) {
    forms.insert(form);
  }
  CHECK(forms == std::set<std::string>{"application/json", "text/csv", "text/plain"});
}

TEST_CASE("every route says which fields of the head it reads", "[server]") {
  using Names = std::set<std::string>;
  CHECK(head_fields("get", "/v1/calibrations") == Names{"If-None-Match", "X-Request-Id"});
  CHECK(head_fields("get", "/v1/events") ==
        Names{"If-None-Match", "Last-Event-ID", "X-Request-Id"});
  CHECK(head_fields("post", "/v1/calibrations") == Names{"Idempotency-Key", "X-Request-Id"});
  CHECK(head_fields("put", "/v1/measurement-sets/{name}") ==
        Names{"Idempotency-Key", "If-Match", "X-Request-Id"});
  CHECK(operation("get", "/v1/calibrations")["responses"].contains("304"));
  CHECK_FALSE(operation("post", "/v1/calibrations")["responses"].contains("304"));
}
