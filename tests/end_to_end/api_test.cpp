#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>

#include <catch2/catch.hpp>
#include <httplib.h>
#include <nlohmann/json.hpp>

#include "server/api/http_server.hpp"
#include "server/json/report_json.hpp"
#include "server/service.hpp"

namespace {

using Json = nlohmann::ordered_json;
using repose::server::HttpServer;
using repose::server::Service;
using repose::server::ServiceOptions;
namespace fs = std::filesystem;

std::string example(const std::string& name) {
  std::ifstream file(fs::path(REPOSE_SOURCE_DIR) / "schemas" / "examples" / name);
  REQUIRE(file);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A folder that goes with the test.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "repose-api-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] ServiceOptions options() const {
    ServiceOptions options;
    options.database = path_ / "repose.db";
    options.workers = 2;
    options.run_jobs = true;
    return options;
  }

 private:
  fs::path path_;
};

/// The service on a free port, and a client of it.
class Api {
 public:
  explicit Api(const Folder& folder)
      : service_(folder.options()),
        server_(service_, {}),
        thread_([this] { server_.run(); }),
        client_("127.0.0.1", server_.port()) {
    client_.set_keep_alive(true);
    client_.set_tcp_nodelay(true);
  }
  ~Api() {
    client_.stop();
    server_.stop();
    thread_.join();
  }
  Api(const Api&) = delete;
  Api& operator=(const Api&) = delete;

  httplib::Response get(const std::string& path) { return checked(client_.Get(path)); }
  httplib::Response remove(const std::string& path) { return checked(client_.Delete(path)); }
  httplib::Response post(const std::string& body, const std::string& type = "application/json") {
    return checked(client_.Post("/v1/calibrations", body, type));
  }
  /// The address of a calibration that was taken on.
  std::string submit(const std::string& study) {
    const httplib::Response response = post(study);
    REQUIRE(response.status == 202);
    REQUIRE(response.has_header("Location"));
    return response.get_header_value("Location");
  }
  /// Asks again until the state is one of those; what it says then.
  Json wait(const std::string& path, const std::set<std::string>& states) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    while (std::chrono::steady_clock::now() < end) {
      Json document = Json::parse(get(path).body);
      if (states.contains(document["state"].get<std::string>())) return document;
      std::this_thread::yield();
    }
    FAIL("the calibration did not come to an end");
    return {};
  }
  [[nodiscard]] Service& service() { return service_; }
  [[nodiscard]] int port() const { return server_.port(); }

 private:
  static httplib::Response checked(const httplib::Result& result) {
    if (!result) throw std::runtime_error("no answer: " + httplib::to_string(result.error()));
    return result.value();
  }

  Service service_;
  HttpServer server_;
  std::thread thread_;
  httplib::Client client_;
};

bool is_problem(const httplib::Response& response, int status) {
  return response.status == status &&
         response.get_header_value("Content-Type") == "application/problem+json" &&
         Json::parse(response.body)["status"] == status;
}

const std::set<std::string> ends{"done", "failed", "cancelled"};

}  // namespace

TEST_CASE("a study that is sent is calibrated, and its fit is served", "[end_to_end]") {
  const Folder folder;
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
  const Folder folder;
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
}

TEST_CASE("a fit is still there after a restart", "[end_to_end]") {
  const Folder folder;
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
  const Folder folder;
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
  const Folder folder;
  Api api(folder);
  const httplib::Response many = api.post(example("invalid/many-at-once.json"));
  CHECK(is_problem(many, 422));
  CHECK(Json::parse(many.body)["errors"].size() == 6);
  CHECK(is_problem(api.post(example("invalid/cut-short.json")), 422));
  CHECK(is_problem(api.post(std::string(900'000, '[')), 422));
  CHECK(Json::parse(api.get("/v1/calibrations").body)["items"].empty());
}

TEST_CASE("requests that are none are refused with a problem", "[end_to_end]") {
  const Folder folder;
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
  const Folder folder;
  Api api(folder);
  CHECK(Json::parse(api.get("/v1/catalogue").body)["effects"].size() >= 4);
  CHECK(Json::parse(api.get("/v1/openapi.json").body)["openapi"] == "3.1.0");
  CHECK(Json::parse(api.get("/healthz").body)["status"] == "ok");
  CHECK(Json::parse(api.get("/livez").body)["status"] == "ok");
}

TEST_CASE("a second server on the port is an error and does not harm the first", "[end_to_end]") {
  const Folder folder;
  Api api(folder);
  CHECK_THROWS_AS(HttpServer(api.service(), {.port = api.port()}), std::runtime_error);
  CHECK(api.get("/livez").status == 200);
}
