/// Api: the service on a free port with its own database, and a client of it.
#pragma once

#include <chrono>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include <catch2/catch.hpp>
#include <httplib.h>
#include <nlohmann/json.hpp>

#include "server/api/api.hpp"
#include "server/api/http_server.hpp"
#include "server/service.hpp"
#include "tests/support/temporary_folder.hpp"

namespace repose::tests {

class Api {
 public:
  explicit Api(const TemporaryFolder& folder, const server::HttpOptions& options = {})
      : service_(options_in(folder)),
        api_(service_),
        server_(api_, options),
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
  httplib::Response get(const std::string& path, const httplib::Headers& fields) {
    return checked(client_.Get(path, fields));
  }
  httplib::Response remove(const std::string& path) { return checked(client_.Delete(path)); }
  httplib::Response post(const std::string& body, const std::string& type = "application/json") {
    return checked(client_.Post("/v1/calibrations", body, type));
  }
  httplib::Response post_to(const std::string& path, const std::string& body) {
    return checked(client_.Post(path, body, "application/json"));
  }
  httplib::Response put(const std::string& path,
                        const std::string& body,
                        const std::string& type,
                        const httplib::Headers& fields = {}) {
    return checked(client_.Put(path, fields, body, type));
  }
  httplib::Response post_with(const httplib::Headers& fields, const std::string& body) {
    return checked(client_.Post("/v1/calibrations", fields, body, "application/json"));
  }
  httplib::Response remove(const std::string& path, const httplib::Headers& fields) {
    return checked(client_.Delete(path, fields));
  }
  /// The address of a calibration that was taken on.
  std::string submit(const std::string& study) {
    const httplib::Response response = post(study);
    REQUIRE(response.status == 202);
    REQUIRE(response.has_header("Location"));
    return response.get_header_value("Location");
  }
  /// Asks again until the state is one of those; what it says then.
  nlohmann::ordered_json wait(const std::string& path, const std::set<std::string>& states) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    while (std::chrono::steady_clock::now() < end) {
      nlohmann::ordered_json document = nlohmann::ordered_json::parse(get(path).body);
      if (states.contains(document["state"].get<std::string>())) return document;
      std::this_thread::yield();
    }
    FAIL("the calibration did not come to an end");
    return {};
  }
  [[nodiscard]] server::Service& service() { return service_; }
  [[nodiscard]] int port() const { return server_.port(); }

 private:
  static server::ServiceOptions options_in(const TemporaryFolder& folder) {
    server::ServiceOptions options;
    options.database = folder / "repose.db";
    options.workers = 2;
    options.run_jobs = true;
    options.webhook_hosts = {"127.0.0.1"};
    return options;
  }
  static httplib::Response checked(const httplib::Result& result) {
    if (!result) throw std::runtime_error("no answer: " + httplib::to_string(result.error()));
    return result.value();
  }

  server::Service service_;
  server::Api api_;
  server::HttpServer server_;
  std::thread thread_;
  httplib::Client client_;
};

}  // namespace repose::tests
