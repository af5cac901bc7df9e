#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "server/api/guard.hpp"
#include "server/api/query.hpp"
#include "server/api/route.hpp"
#include "server/service.hpp"

namespace {

using repose::server::Query;
using repose::server::refuse;
using repose::server::Request;
using repose::server::RequestHead;
using repose::server::Route;
using repose::server::routes;

RequestHead head(const std::string& method = "GET") {
  return {method, {{"Host", "localhost:8080"}}};
}

/// The status with which a head is refused, 0 where it is not.
int status(const RequestHead& head) {
  const auto refusal = refuse(head, {"dem.example"});
  return refusal ? refusal->status : 0;
}

RequestHead with(RequestHead head, const std::string& name, const std::string& value) {
  head.fields.emplace_back(name, value);
  return head;
}

Request asking(const std::string& name, const std::string& value) {
  Request request;
  request.query.emplace(name, value);
  return request;
}

}  // namespace

TEST_CASE("no two routes answer the same request, and all names differ", "[server]") {
  std::set<std::string> seen, names;
  for (const Route& route : routes()) {
    CHECK(seen.insert(std::string(route.method) + " " + std::string(route.pattern)).second);
    CHECK(names.insert(std::string(route.name)).second);
    CHECK(!route.summary.empty());
    CHECK(route.handler != nullptr);
  }
}

TEST_CASE("every route is answered by its own method and by no other", "[server]") {
  char name[] = "/tmp/repose-routes-XXXXXX";
  REQUIRE(mkdtemp(name) != nullptr);
  {
    repose::server::ServiceOptions options;
    options.database = std::filesystem::path(name) / "repose.db";
    repose::server::Service service(options);
    for (const Route& route : routes()) {
      std::string path(route.pattern);
      if (const auto at = path.find("{id}"); at != std::string::npos) path.replace(at, 4, "7");
      for (const char* method : {"GET", "HEAD", "POST", "DELETE", "PUT", "PATCH", "OPTIONS"}) {
        INFO(method << " " << path);
        const std::string_view plain = std::string_view(method) == "HEAD" ? "GET" : method;
        const auto is_allowed = [&](const Route& other) {
          return other.pattern == route.pattern && other.method == plain;
        };
        const bool allowed = std::ranges::any_of(routes(), is_allowed);
        Request request;
        request.method = method;
        request.path = path;
        CHECK((respond(service, request).status != 405) == allowed);
      }
    }
  }
  std::filesystem::remove_all(name);
}

TEST_CASE("a material is answered by its name, and one that is not there with those that are",
          "[server]") {
  char name[] = "/tmp/repose-routes-XXXXXX";
  REQUIRE(mkdtemp(name) != nullptr);
  {
    repose::server::ServiceOptions options;
    options.database = std::filesystem::path(name) / "repose.db";
    repose::server::Service service(options);
    const auto get = [&](const char* path) {
      Request request;
      request.method = "GET";
      request.path = path;
      return respond(service, request);
    };
    CHECK(get("/v1/materials").body.find("\"canola\"") != std::string::npos);
    CHECK(get("/v1/materials/wheat").status == 200);
    CHECK(get("/v1/materials/wheat").body.find("\"name\":\"wheat\"") != std::string::npos);
    const auto missing = get("/v1/materials/whea");
    CHECK(missing.status == 404);
    CHECK(missing.body.find("wheat") != std::string::npos);
    CHECK(get("/v1/materials/").status == 404);
    CHECK(get("/v1/materials/wheat/x").status == 404);
  }
  std::filesystem::remove_all(name);
}

TEST_CASE("a head without faults is not refused", "[server]") {
  CHECK(status(head()) == 0);
  CHECK(status(with(head("POST"), "Content-Length", "17")) == 0);
  CHECK(status(with(head(), "content-length", "0")) == 0);
  CHECK(status(with(head("DELETE"), "Content-Length", "3")) == 0);
}

TEST_CASE("a body whose end is not certain is refused", "[server]") {
  CHECK(status(head("POST")) == 411);
  CHECK(status(with(head("POST"), "transfer-encoding", "chunked")) == 411);
  CHECK(status(with(with(head("POST"), "Content-Length", "6"), "Transfer-Encoding", "chunked")) ==
        411);
  CHECK(status(with(with(head("POST"), "Content-Length", "6"), "Content-Length", "6")) == 400);
  for (const char* length : {"", "-1", "+1", "0x10", "6, 6", "99999999999999999999"}) {
    CHECK(status(with(head("POST"), "Content-Length", length)) == 400);
  }
  CHECK(status(with(head("GET"), "Content-Length", "6")) == 400);
  CHECK(status(with(head("HEAD"), "Content-Length", "6")) == 400);
}

TEST_CASE("a compressed body is refused", "[server]") {
  CHECK(status(with(with(head("POST"), "Content-Length", "6"), "Content-Encoding", "gzip")) == 415);
}

TEST_CASE("a host that is not ours is refused", "[server]") {
  for (const char* host : {"localhost",
                           "LOCALHOST:1",
                           "127.0.0.1:80",
                           "[::1]",
                           "[::1]:80",
                           "dem.example",
                           "dem.example:8080"}) {
    CHECK(status({"GET", {{"Host", host}}}) == 0);
  }
  for (const char* host : {"",
                           "evil.example",
                           "localhost.evil.example",
                           "127.0.0.1.evil.example",
                           "[::1",
                           "dem.example@evil.example",
                           "10.0.0.1"}) {
    CHECK(status({"GET", {{"Host", host}}}) == 421);
  }
  CHECK(status({"GET", {}}) == 400);
  CHECK(status(with(head(), "host", "localhost")) == 400);
}

TEST_CASE("a field that breaks its line is refused", "[server]") {
  CHECK(status(with(head(), "X-Test", "a\r\nEvil: 1")) == 400);
  CHECK(status(with(head(), "X-Test", std::string("a\0b", 3))) == 400);
  CHECK(status(with(head(), "X\nTest", "a")) == 400);
}

TEST_CASE("sixty-four fields are read and sixty-five are not", "[server]") {
  RequestHead many = head();
  while (many.fields.size() < 64) many.fields.emplace_back("X", "y");
  CHECK(status(many) == 0);
  CHECK(status(with(many, "X", "y")) == 431);
}

TEST_CASE("more than one range is refused", "[server]") {
  CHECK(status(with(head(), "Range", "bytes=0-")) == 0);
  CHECK(status(with(head(), "Range", "bytes=0-,1-")) == 416);
}

TEST_CASE("a field of the query is a whole number in its bounds or a problem", "[server]") {
  const Request good = asking("limit", "200");
  CHECK(Query(good).whole("limit", 1, 200) == 200);
  CHECK(!Query(good).whole("before", 1));
  for (const char* wrong :
       {"", "0", "-1", "201", "1.0", "1 ", " 1", "x", "0x1", "99999999999999999999999"}) {
    const Request request = asking("limit", wrong);
    Query query(request);
    CHECK(!query.whole("limit", 1, 200));
    REQUIRE(query.problems().size() == 1);
    CHECK(query.problems()[0].pointer == "?limit");
  }
}

TEST_CASE("a field that is there twice is a problem", "[server]") {
  Request request = asking("limit", "1");
  request.query.emplace("limit", "2");
  Query query(request);
  CHECK(query.whole("limit", 1));
  CHECK(query.problems().size() == 1);
}

TEST_CASE("a field that the route does not have is a problem", "[server]") {
  const Route& list = routes()[1];
  CHECK(unknown_fields(asking("limit", "1"), list).empty());
  CHECK(unknown_fields(asking("limt", "1"), list).at(0).allowed == "limit, before");
}
