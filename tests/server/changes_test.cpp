// Requests that change something: done once for each key, and only where what the client has read
// still stands.

#include <barrier>
#include <map>
#include <string>
#include <thread>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "server/api/api.hpp"
#include "server/service.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using repose::server::Api;
using repose::server::Reply;
using repose::server::Request;
using repose::server::Service;
using repose::server::ServiceOptions;
using repose::tests::TemporaryFolder;

using Fields = std::map<std::string, std::string>;

const std::string set_address = "/v1/measurement-sets/may";

/// A service without sockets.
struct Asked {
  explicit Asked(const TemporaryFolder& folder) : service(options(folder)), api(service) {}

  Reply get(const std::string& path, const Fields& fields = {}) {
    Request request;
    request.method = "GET";
    request.path = path;
    request.fields = fields;
    return api.respond(request);
  }

  /// Puts a table of one measurement, or of as many lines with the same.
  Reply put_table(const std::string& value,
                  const Fields& fields = {},
                  const std::string& material = "glass",
                  int lines = 1) {
    Request request;
    request.method = "PUT";
    request.path = set_address;
    request.query = {{"material", material}};
    request.content_type = "text/csv";
    request.body = "experiment,observable,value,unit,standard_error\n";
    for (int i = 0; i < lines; ++i) request.body += "drop,restitution," + value + ",1,0.02\n";
    request.fields = fields;
    return api.respond(request);
  }

  static ServiceOptions options(const TemporaryFolder& folder) {
    ServiceOptions result;
    result.database = folder / "a.db";
    return result;
  }

  Service service;
  Api api;
};

std::string header(const Reply& reply, const std::string& name) {
  for (const auto& [own, value] : reply.headers) {
    if (own == name) return value;
  }
  return {};
}

int version(const Reply& reply) { return nlohmann::json::parse(reply.body)["version"]; }

}  // namespace

TEST_CASE("a key that was used with another query is refused", "[server]") {
  const TemporaryFolder folder;
  Asked asked(folder);
  const Fields key{{"idempotency-key", "k"}};
  CHECK(asked.put_table("0.6", key, "soybean").status == 200);
  CHECK(header(asked.put_table("0.6", key, "soybean"), "Idempotency-Replayed") == "true");
  CHECK(asked.put_table("0.6", key, "wheat").status == 422);
}

TEST_CASE("a change of what was read is done once for its key", "[server]") {
  const TemporaryFolder folder;
  Asked asked(folder);
  asked.put_table("0.6");
  const std::string tag = header(asked.get(set_address), "ETag");
  const Fields both{{"if-match", tag}, {"idempotency-key", "k"}};
  const Reply first = asked.put_table("0.7", both);
  CHECK(first.status == 200);
  const Reply again = asked.put_table("0.7", both);
  CHECK(again.status == 200);
  CHECK(again.body == first.body);
  CHECK(header(again, "Idempotency-Replayed") == "true");
  CHECK(asked.put_table("0.8", {{"if-match", tag}, {"idempotency-key", "l"}}).status == 412);
}

TEST_CASE("what was read in any of its forms may be changed", "[server]") {
  const TemporaryFolder folder;
  Asked asked(folder);
  asked.put_table("0.6");
  for (const char* form : {"application/json", "text/csv"}) {
    INFO(form);
    const std::string tag = header(asked.get(set_address, {{"accept", form}}), "ETag");
    CHECK(asked.put_table(form == std::string("text/csv") ? "0.7" : "0.8", {{"if-match", tag}})
              .status == 200);
    CHECK(asked.put_table("0.9", {{"if-match", tag}}).status == 412);
  }
}

TEST_CASE("between the look at what was read and its change nobody else changes it", "[server]") {
  const TemporaryFolder folder(TemporaryFolder::fast());
  Asked asked(folder);
  for (int round = 0; round < 20; ++round) {
    const std::string digits = std::to_string(100 + round);
    asked.put_table("0.5" + digits);
    const Reply read = asked.get(set_address);
    std::barrier together(2);
    int other_status = 0;
    std::thread other([&] {
      together.arrive_and_wait();
      for (int i = 0; i < 5; ++i) asked.get(set_address);  // while the first look is taken
      other_status = asked.put_table("0.6" + digits).status;
    });
    together.arrive_and_wait();
    constexpr int lines = 5000;  // it takes a while to read them, between look and change
    const Reply changed =
        asked.put_table("0.7" + digits, {{"if-match", header(read, "ETag")}}, "glass", lines);
    other.join();
    CHECK(other_status == 200);
    if (changed.status == 412) continue;  // the other one was first
    CHECK(changed.status == 200);
    CHECK(version(changed) == version(read) + 1);
  }
}

TEST_CASE("a media type is the same in any case", "[server]") {
  const TemporaryFolder folder;
  Asked asked(folder);
  Request request;
  request.method = "PUT";
  request.path = set_address;
  request.query = {{"material", "glass"}};
  request.content_type = "Text/CSV; charset=utf-8";
  request.body = "experiment,observable,value,unit,standard_error\ndrop,restitution,0.6,1,0.02\n";
  CHECK(asked.api.respond(request).status == 200);
}

TEST_CASE("what must not be there yet is not put a second time", "[server]") {
  const TemporaryFolder folder;
  Asked asked(folder);
  const Fields absent{{"if-none-match", "*"}};
  CHECK(asked.put_table("0.6", absent).status == 200);
  CHECK(asked.put_table("0.7", absent).status == 412);
  CHECK(version(asked.get(set_address)) == 1);
}

TEST_CASE("what a client has by a weak tag is not sent again, and not changed by it", "[server]") {
  const TemporaryFolder folder;
  Asked asked(folder);
  asked.put_table("0.6");
  const std::string weak = "W/" + header(asked.get(set_address), "ETag");
  CHECK(asked.get(set_address, {{"if-none-match", weak}}).status == 304);
  CHECK(asked.put_table("0.7", {{"if-match", weak}}).status == 412);
}

TEST_CASE("names that are steps of an address are no names", "[server]") {
  const TemporaryFolder folder;
  Asked asked(folder);
  const std::string content = R"({"material":"glass","measurements":[{"experiment":"drop",)"
                              R"("observable":"restitution","value":0.6,"unit":"1",)"
                              R"("standard_error":0.02}]})";
  CHECK(asked.service.put_measurement_set("...", content, std::nullopt));
  CHECK_FALSE(asked.service.put_measurement_set(".", content, std::nullopt));
  CHECK_FALSE(asked.service.put_measurement_set("..", content, std::nullopt));
}
