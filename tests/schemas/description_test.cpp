// The API does what its own description says: requests made from it, good and bad, get answers that
// it describes, and never one that the service has failed.

#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "server/api/api.hpp"
#include "server/json/openapi.hpp"
#include "server/service.hpp"
#include "tests/schemas/schema_check.hpp"
#include "tests/support/example.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using repose::server::Api;
using repose::server::Reply;
using repose::server::Request;
using repose::tests::example;
using repose::tests::Json;
using repose::tests::TemporaryFolder;
using repose::tests::violations;

Reply ask(Api& api, const std::string& method, const std::string& path) {
  Request request;
  request.method = method;
  request.path = path;
  return api.respond(request);
}

/// Requests from the description, each drawn anew; the same from the same seed.
class Requests {
 public:
  Requests(const Json& description, std::uint64_t seed) : description_(description), random_(seed) {
    for (const auto& [path, methods] : description["paths"].items()) {
      for (const auto& [method, operation] : methods.items()) {
        operations_.push_back({path, method, &operation});
      }
    }
    for (const char* name : {"valid/drop-minimal.json",
                             "valid/boac2010-soybean.json",
                             "invalid/many-at-once.json",
                             "invalid/cut-short.json"}) {
      bodies_.push_back(example(name));
    }
    bodies_.push_back(
        R"({"material":"m","measurements":[{"experiment":"drop","observable":"restitution",)"
        R"("value":0.6,"unit":"1","standard_error":0.02}]})");
  }

  Request next() {
    const auto& [path, method, operation] = one_of(operations_);
    Request request;
    request.path = filled(path);
    request.method = chance(10) ? one_of(methods_) : method;
    for (char& letter : request.method) {
      if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
    }
    for (const Json& parameter : operation->value("parameters", Json::array())) {
      if (parameter.value("in", "") != "query" || chance(2)) continue;
      const bool whole = parameter["schema"]["type"] == "integer";
      request.query.emplace(parameter["name"].get<std::string>(),
                            whole && !chance(3) ? one_of(numbers_) : one_of(texts_));
    }
    if (chance(20)) request.query.emplace("colour", "red");
    for (const char* field : {"accept",
                              "if-none-match",
                              "if-match",
                              "idempotency-key",
                              "last-event-id",
                              "x-request-id"}) {
      if (chance(5)) request.fields[field] = one_of(texts_);
    }
    if (operation->contains("requestBody")) {
      request.content_type = chance(5) ? one_of(types_) : "application/json";
      const bool of_set = path.find("measurement-sets") != std::string::npos;
      request.body = of_set && chance(2) ? bodies_.back() : body();
    }
    return request;
  }

  /// What is described of a request; null where it is for no operation.
  [[nodiscard]] const Json* operation_of(const Request& request, const std::string& pattern) const {
    for (const auto& [path, method, operation] : operations_) {
      std::string name = request.method == "HEAD" ? "GET" : request.method;
      for (char& letter : name) letter = static_cast<char>(letter - 'A' + 'a');
      if (path == pattern && method == name) return operation;
    }
    return nullptr;
  }

 private:
  struct Operation {
    std::string path;
    std::string method;
    const Json* description;
  };

  bool chance(unsigned of) { return random_() % of == 0; }
  template <class T>
  const T& one_of(const std::vector<T>& choices) {
    return choices[random_() % choices.size()];
  }

  std::string filled(std::string path) {
    if (const auto at = path.find("{id}"); at != std::string::npos) {
      path.replace(at, 4, one_of(numbers_));
    }
    if (const auto at = path.find("{name}"); at != std::string::npos) {
      path.replace(at, 6, chance(2) ? std::string("soybean") : one_of(texts_));
    }
    if (const auto at = path.find("{effect}"); at != std::string::npos) {
      path.replace(at, 8, one_of(texts_));
    }
    return path;
  }

  /// A document that is good or nearly so, or anything at all.
  std::string body() {
    if (chance(8)) return one_of(texts_);
    Json document = Json::parse(one_of(bodies_), nullptr, false);
    if (document.is_discarded()) return bodies_[3];
    for (int i = static_cast<int>(random_() % 3); i > 0; --i) spoil(document);
    return document.dump();
  }

  void spoil(Json& document) {
    Json* place = &document;
    while (place->is_structured() && !place->empty() && !chance(4)) {
      auto member = place->begin();
      std::advance(member, static_cast<std::ptrdiff_t>(random_() % place->size()));
      place = &*member;
    }
    const Json flipped[] = {nullptr,
                            true,
                            -1,
                            0,
                            1e308,
                            18446744073709551615U,
                            "",
                            "x",
                            std::string(2000, 'y'),
                            Json::array(),
                            Json::object(),
                            Json::array({1, "a", nullptr}),
                            Json{{"\xC3\xBC/~", 1}}};
    *place = flipped[random_() % std::size(flipped)];
  }

  const Json& description_;
  std::mt19937_64 random_;
  std::vector<Operation> operations_;
  std::vector<std::string> bodies_;
  std::vector<std::string> methods_{"get", "head", "post", "put", "delete", "patch", "options"};
  std::vector<std::string> numbers_{"1",
                                    "2",
                                    "3",
                                    "50",
                                    "200",
                                    "0",
                                    "-1",
                                    "201",
                                    "9223372036854775807",
                                    "9223372036854775808",
                                    "1e3"};
  std::vector<std::string> texts_{"",
                                  "x",
                                  "true",
                                  "application/json",
                                  "text/csv",
                                  "*",
                                  "17",
                                  "text/event-stream",
                                  "\xC3\xBC\xE2\x82\xAC",
                                  "a b",
                                  "../x",
                                  "\"tag\"",
                                  std::string(300, 'z'),
                                  "'; DROP TABLE event; --",
                                  std::string(40, '['),
                                  "{\"a\":1,\"a\":2}"};
  std::vector<std::string> types_{"", "text/plain", "text/csv", "APPLICATION/JSON; charset=utf-8"};
};

/// What is wrong with a reply, as the description has it; empty where nothing is.
std::string fault(const Json& description, const Json* operation, const Reply& reply) {
  const std::string status = std::to_string(reply.status);
  if (reply.status >= 500) return "status " + status;
  const bool refused = reply.status >= 400;
  const std::string type = reply.content_type.substr(0, reply.content_type.find(';'));
  if (operation == nullptr)
    return refused && type == "application/problem+json" ? "" : "no problem";
  const Json& responses = (*operation)["responses"];
  if (reply.status == 304) {
    if (!responses.contains("304")) return "status 304 is not described";
    return reply.body.empty() ? "" : "304 with a body";
  }
  const std::string key = refused ? "4XX" : status;
  if (!responses.contains(key)) return "status " + status + " is not described";
  if (!responses[key]["content"].contains(type)) return type + " is not described";
  if (type.find("json") == std::string::npos) return "";
  const auto wrong =
      violations(description, responses[key]["content"][type]["schema"], Json::parse(reply.body));
  return wrong.empty() ? "" : wrong.front();
}

/// What a reference leads to; else what is there itself.
const Json& resolved(const Json& description, const Json& json) {
  if (!json.contains("$ref")) return json;
  return description.at(Json::json_pointer(json["$ref"].get<std::string>().substr(1)));
}

std::string shown(const Request& request) {
  std::string text = request.method + " " + request.path;
  for (const auto& [name, value] : request.query) text += " ?" + name + "=" + value;
  for (const auto& [name, value] : request.fields) text += " " + name + ":" + value;
  return text + "\n" + request.body.substr(0, 2000);
}

}  // namespace

TEST_CASE("eight thousand requests made from the description get answers that it describes",
          "[schemas][slow]") {
  const TemporaryFolder folder;
  repose::server::ServiceOptions options;
  options.database = folder / "a.db";
  repose::server::Service service(options);
  Api api(service);
  const Json description = Json::parse(ask(api, "GET", "/v1/openapi.json").body);
  constexpr std::uint64_t seed = 20261129;
  Requests requests(description, seed);
  std::map<std::string, int> outcomes;
  for (int i = 0; i < 8000; ++i) {
    Request request = requests.next();
    Request routed = request;
    const auto route = repose::server::find_route(routed);
    const Json* const operation =
        route ? requests.operation_of(request, std::string((*route)->pattern)) : nullptr;
    const Reply reply = api.respond(request);
    if (reply.stream) CHECK_NOTHROW(reply.stream());
    const std::string wrong = fault(description, operation, reply);
    INFO("request " << i << " of seed " << seed << ": " << shown(request) << "\nanswer "
                    << reply.status << " " << reply.body.substr(0, 500));
    CHECK(wrong.empty());
    if (!wrong.empty()) WARN(wrong);
    ++outcomes[std::to_string(reply.status / 100) + "xx"];
    if (route) ++outcomes[std::string((*route)->name) + (reply.status < 300 ? " done" : "")];
  }
  CHECK(outcomes["2xx"] > 500);
  CHECK(outcomes["4xx"] > 500);
  for (const repose::server::Route& route : repose::server::routes()) {
    INFO(route.name);
    CHECK(outcomes[std::string(route.name)] + outcomes[std::string(route.name) + " done"] > 10);
  }
  CHECK(outcomes["submitCalibration done"] > 5);
  CHECK(outcomes["putMeasurementSet done"] > 5);
}

TEST_CASE("the description is what OpenAPI 3.1 asks for", "[schemas]") {
  const Json description = Json::parse(repose::server::print_openapi(repose::server::routes()));
  CHECK(description["openapi"] == "3.1.0");
  for (const char* name : {"title", "version"}) CHECK(description["info"][name].is_string());
  std::set<std::string> names;
  for (const auto& [path, methods] : description["paths"].items()) {
    CHECK(path.starts_with('/'));
    for (const auto& [method, operation] : methods.items()) {
      INFO(method << " " << path);
      CHECK(std::set<std::string>{"get", "put", "post", "delete", "patch"}.contains(method));
      CHECK(names.insert(operation["operationId"].get<std::string>()).second);
      std::set<std::string> in_path;
      for (const Json& described : operation.value("parameters", Json::array())) {
        const Json& parameter = resolved(description, described);
        CHECK(parameter["schema"].is_object());
        if (parameter["in"] != "path") continue;
        CHECK(parameter["required"] == true);
        in_path.insert("{" + parameter["name"].get<std::string>() + "}");
      }
      std::size_t open = 0;
      for (std::size_t at = path.find('{'); at != std::string::npos; at = path.find('{', at + 1)) {
        CHECK(in_path.contains(path.substr(at, path.find('}', at) - at + 1)));
        ++open;
      }
      CHECK(in_path.size() == open);
      for (const auto& [status, response] : operation["responses"].items()) {
        CHECK((status.size() == 3 && status[0] >= '1' && status[0] <= '5'));
        CHECK(response["description"].is_string());
        CHECK(response.contains("content") == (status != "304"));
        const Json content = response.value("content", Json::object());
        for (const auto& [type, body] : content.items()) {
          CHECK(type.find('/') != std::string::npos);
          CHECK(body["schema"].is_object());
        }
      }
    }
  }
}
