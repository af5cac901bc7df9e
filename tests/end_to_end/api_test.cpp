#include "tests/support/api.hpp"

#include <atomic>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "server/api/http_server.hpp"
#include "server/json/report_json.hpp"
#include "server/service.hpp"
#include "tests/support/example.hpp"

namespace {

using Json = nlohmann::ordered_json;
using repose::server::HttpServer;
using repose::tests::Api;
using repose::tests::example;
using repose::tests::TemporaryFolder;
namespace fs = std::filesystem;

bool is_problem(const httplib::Response& response, int status) {
  return response.status == status &&
         response.get_header_value("Content-Type") == "application/problem+json" &&
         Json::parse(response.body)["status"] == status;
}

const std::set<std::string> ends{"done", "failed", "cancelled"};

}  // namespace

TEST_CASE("a study that is sent is calibrated, and its fit is served", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  const std::string path = api.submit(example("valid/drop-minimal.json"));
  const Json document = api.wait(path, ends);
  REQUIRE(document["state"] == "done");
  const auto read = repose::server::parse_document(document.dump());
  if (!read) FAIL(read.error());
  REQUIRE(read->fit);
  REQUIRE(read->fit->parameters.size() == 1);
  // One grain on one wall: the restitution asked for is the restitution measured.
  CHECK(read->fit->parameters[0].value == Approx(0.6).margin(0.04));

  const Json list = Json::parse(api.get("/v1/calibrations").body);
  REQUIRE(list["items"].size() == 1);
  CHECK(list["items"][0]["name"] == document["name"]);
  CHECK(!list["items"][0].contains("study"));
  CHECK(list["next"].is_null());

  const Json best = Json::parse(api.get("/v1/best-fits?name=one%20grain%20dropped").body);
  REQUIRE(best["items"].size() == 1);
  CHECK(best["items"][0]["calibration"] == document["id"]);
  CHECK(Json::parse(api.get("/v1/best-fits?name=another").body)["items"].empty());
}

TEST_CASE("pages hold every evaluation once", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  const std::string path = api.submit(example("valid/drop-minimal.json"));
  api.wait(path, ends);
  const Json whole = Json::parse(api.get(path + "/evaluations?limit=200").body);
  REQUIRE(whole["items"].size() > 5);
  for (const int limit : {1, 5}) {
    std::vector<Json> items;
    Json next = nullptr;
    do {
      std::string query = "/evaluations?limit=" + std::to_string(limit);
      if (!next.is_null()) query += "&after=" + next.dump();
      const httplib::Response response = api.get(path + query);
      REQUIRE(response.status == 200);
      const Json page = Json::parse(response.body);
      for (const Json& item : page["items"]) items.push_back(item);
      next = page["next"];
    } while (!next.is_null());
    CHECK(Json(items) == whole["items"]);
  }
  // The same by following the links.
  std::vector<Json> items;
  for (std::string next = path + "/evaluations?limit=5"; !next.empty();) {
    const httplib::Response response = api.get(next);
    REQUIRE(response.status == 200);
    const Json page = Json::parse(response.body);
    for (const Json& item : page["items"]) items.push_back(item);
    const std::string link = response.get_header_value("Link");
    next.clear();
    if (link.empty()) continue;
    next = link.substr(1, link.find('>') - 1);
    CHECK(link == "<" + next + ">; rel=\"next\"");
  }
  CHECK(Json(items) == whole["items"]);
}

TEST_CASE("a fit is still there after a restart", "[end_to_end]") {
  const TemporaryFolder folder;
  std::string path, before;
  {
    Api api(folder);
    path = api.submit(example("valid/drop-minimal.json"));
    api.wait(path, ends);
    before = api.get(path).body;
  }
  Api api(folder);
  CHECK(api.get(path).body == before);
}

TEST_CASE("a running calibration is cancelled, and only once", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  const std::string running = api.submit(example("valid/boac2010-soybean.json"));
  const std::string queued = api.submit(example("valid/held-out-and-allowance.json"));
  CHECK(api.wait(running, {"running"})["fit"].is_null());
  CHECK(api.remove(queued).status == 202);
  CHECK(api.wait(queued, ends)["state"] == "cancelled");
  CHECK(api.remove(running).status == 202);
  CHECK(api.wait(running, ends)["state"] == "cancelled");
  CHECK(is_problem(api.remove(running), 409));
  CHECK(is_problem(api.remove("/v1/calibrations/99"), 404));
}

TEST_CASE("a study with problems is refused with all of them", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  const httplib::Response many = api.post(example("invalid/many-at-once.json"));
  CHECK(is_problem(many, 422));
  CHECK(Json::parse(many.body)["errors"].size() == 6);
  CHECK(is_problem(api.post(example("invalid/cut-short.json")), 422));
  CHECK(is_problem(api.post(std::string(900'000, '[')), 422));
  CHECK(Json::parse(api.get("/v1/calibrations").body)["items"].empty());
}

TEST_CASE("requests that are none are refused with a problem", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  CHECK(is_problem(api.post("{}", "text/plain"), 415));
  CHECK(is_problem(api.post(std::string((1U << 20U) + 1, ' ')), 413));
  CHECK(is_problem(api.get("/v1/calibrations?limit=0"), 400));
  CHECK(is_problem(api.get("/v1/calibrations?limit=201"), 400));
  CHECK(is_problem(api.get("/v1/calibrations?before=x"), 400));
  CHECK(is_problem(api.get("/v1/calibrations?colour=red"), 400));
  for (const char* path : {"/",
                           "/v1",
                           "/v1/",
                           "/v2/catalogue",
                           "/v1/calibrations/",
                           "/v1/calibrations/x",
                           "/v1/calibrations/0",
                           "/v1/calibrations/1/x",
                           "/v1/calibrations/99",
                           "/v1/calibrations/99/evaluations",
                           "/v1/calibrations/99999999999999999999",
                           "/v1/catalogue/../catalogue"}) {
    INFO(path);
    CHECK(is_problem(api.get(path), 404));
  }
  const httplib::Response wrong_method = api.remove("/v1/catalogue");
  CHECK(is_problem(wrong_method, 405));
  CHECK(wrong_method.get_header_value("Allow") == "GET, HEAD");
  CHECK(api.remove("/v1/calibrations").get_header_value("Allow") == "POST, GET, HEAD");
}

TEST_CASE("catalogue, description and health are served", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  CHECK(Json::parse(api.get("/v1/catalogue").body)["effects"].size() >= 4);
  CHECK(Json::parse(api.get("/v1/openapi.json").body)["openapi"] == "3.1.0");
  CHECK(Json::parse(api.get("/healthz").body)["status"] == "ok");
  CHECK(Json::parse(api.get("/livez").body)["status"] == "ok");
}

TEST_CASE("a second server on the port is an error and does not harm the first", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  CHECK_THROWS_AS(HttpServer([](const repose::server::Request&) { return repose::server::Reply{}; },
                             {.port = api.port()}),
                  std::runtime_error);
  CHECK(api.get("/livez").status == 200);
}

TEST_CASE("a key makes a submission happen once, however often it is sent", "[end_to_end]") {
  const TemporaryFolder folder;
  std::string body;
  {
    Api api(folder);
    const std::string study = example("valid/drop-minimal.json");
    const httplib::Response first = api.post_with({{"Idempotency-Key", "night-17"}}, study);
    REQUIRE(first.status == 202);
    CHECK(!first.has_header("Idempotency-Replayed"));
    const httplib::Response again = api.post_with({{"Idempotency-Key", "night-17"}}, study);
    CHECK(again.status == 202);
    CHECK(again.body == first.body);
    CHECK(again.get_header_value("Location") == first.get_header_value("Location"));
    CHECK(again.get_header_value("Idempotency-Replayed") == "true");
    CHECK(is_problem(api.post_with({{"Idempotency-Key", "night-17"}}, study + " "), 422));
    CHECK(api.post_with({{"Idempotency-Key", "night-18"}}, study).status == 202);
    CHECK(is_problem(api.post_with({{"Idempotency-Key", "two words"}}, study), 400));
    CHECK(is_problem(api.post_with({{"Idempotency-Key", std::string(65, 'x')}}, study), 400));
    // What was refused was not done: with the same key it may be mended.
    CHECK(api.post_with({{"Idempotency-Key", "k"}}, "{}").status == 422);
    CHECK(api.post_with({{"Idempotency-Key", "k"}}, study).status == 202);
    CHECK(Json::parse(api.get("/v1/calibrations").body)["items"].size() == 3);
    body = first.body;
  }
  Api api(folder);  // also after a restart
  CHECK(api.post_with({{"Idempotency-Key", "night-17"}}, example("valid/drop-minimal.json")).body ==
        body);
}

TEST_CASE("fifty clients at once with one key make one calibration", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  std::vector<std::thread> clients;
  std::atomic<int> taken_on = 0;
  const std::string study = example("valid/drop-minimal.json");
  for (int i = 0; i < 50; ++i) {
    clients.emplace_back([&] {
      httplib::Client client("127.0.0.1", api.port());
      const auto result =
          client.Post("/v1/calibrations", {{"Idempotency-Key", "k"}}, study, "application/json");
      if (result && result->status == 202) ++taken_on;
    });
  }
  for (std::thread& client : clients) client.join();
  CHECK(taken_on == 50);
  CHECK(Json::parse(api.get("/v1/calibrations").body)["items"].size() == 1);
}

TEST_CASE("what a client has already is not sent again", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  for (const std::string path : {"/v1/catalogue", "/v1/calibrations", "/v1/materials/soybean"}) {
    INFO(path);
    const httplib::Response first = api.get(path);
    const std::string tag = first.get_header_value("ETag");
    REQUIRE(tag.size() > 2);
    const httplib::Response same = api.get(path, {{"If-None-Match", "\"other\", " + tag}});
    CHECK(same.status == 304);
    CHECK(same.body.empty());
    CHECK(same.get_header_value("ETag") == tag);
    CHECK(api.get(path, {{"If-None-Match", "\"other\""}}).body == first.body);
  }
  const std::string before = api.get("/v1/calibrations").get_header_value("ETag");
  api.submit(example("valid/drop-minimal.json"));
  CHECK(api.get("/v1/calibrations", {{"If-None-Match", before}}).status == 200);
}

TEST_CASE("a change that names what it changes is not made when that has changed", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  const std::string path = api.submit(example("valid/drop-minimal.json"));
  api.wait(path, ends);
  const std::string tag = api.get(path).get_header_value("ETag");
  CHECK(is_problem(api.remove(path, {{"If-Match", "\"other\""}}), 412));
  CHECK(is_problem(api.remove("/v1/calibrations/99", {{"If-Match", tag}}), 412));
  CHECK(is_problem(api.remove(path, {{"If-Match", tag}}), 409));  // it has ended, but is the same
}

TEST_CASE("a request has an identity, the client's where it gives one", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  CHECK(api.get("/livez", {{"X-Request-Id", "abc-1"}}).get_header_value("X-Request-Id") == "abc-1");
  const std::string made = api.get("/livez").get_header_value("X-Request-Id");
  CHECK(made.size() == 16);
  CHECK(api.get("/v2", {{"X-Request-Id", "two words"}}).get_header_value("X-Request-Id").size() ==
        16);
  CHECK(api.get("/livez").get_header_value("X-Request-Id") != made);
}

TEST_CASE("what is not finished says when to ask again", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  const httplib::Response taken_on = api.post(example("valid/drop-minimal.json"));
  CHECK(taken_on.get_header_value("Retry-After") == "1");
  const std::string path = taken_on.get_header_value("Location");
  const httplib::Response running = api.get(path);
  if (Json::parse(running.body)["finished_at"].is_null()) CHECK(running.has_header("Retry-After"));
  api.wait(path, ends);
  CHECK(!api.get(path).has_header("Retry-After"));
}

TEST_CASE("figures count what was asked, by route and status", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  CHECK(api.get("/readyz").status == 200);
  for (int i = 0; i < 3; ++i) api.get("/v1/calibrations/99");
  api.get("/nothing/here");
  api.wait(api.submit(example("valid/drop-minimal.json")), ends);
  const httplib::Response page = api.get("/metrics");
  CHECK(page.get_header_value("Content-Type").find("version=0.0.4") != std::string::npos);
  for (const std::string line : {
           "repose_requests_total{route=\"GET /v1/calibrations/{id}\",status=\"404\"} 3\n",
           "repose_requests_total{route=\"none\",status=\"404\"} 1\n",
           "repose_requests_total{route=\"POST /v1/calibrations\",status=\"202\"} 1\n",
           "repose_calibrations{state=\"done\"} 1\n",
           "repose_event_streams 0\n",
           "# TYPE repose_request_seconds histogram\n",
       }) {
    INFO(line);
    CHECK(page.body.find(line) != std::string::npos);
  }
  CHECK(page.body.find("repose_evaluations_total 0\n") == std::string::npos);
}
