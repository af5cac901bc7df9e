#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/support/api.hpp"
#include "tests/support/example.hpp"
#include "tests/support/wire.hpp"

namespace {

using namespace repose::tests;
using Json = nlohmann::ordered_json;

std::string drop_study() { return example("valid/drop-minimal.json"); }

Wire follow(const Api& api, const std::string& path, const std::string& fields = "") {
  Wire wire(api.port());
  wire.send("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n" + fields + "\r\n");
  return wire;
}

struct Event {
  std::int64_t id = 0;
  std::string kind;
  std::string data;
  bool operator==(const Event&) const = default;
};

/// The events in the text of a stream; one that is cut off is none.
std::vector<Event> events_in(const std::string& text) {
  std::vector<Event> events;
  for (auto at = text.find("\nid: "); at != std::string::npos; at = text.find("\nid: ", at + 1)) {
    const auto end = text.find("\n\n", at + 1);
    if (end == std::string::npos) break;
    std::istringstream lines(text.substr(at + 1, end - at - 1));
    std::string id, kind, data;
    std::getline(lines, id);
    std::getline(lines, kind);
    std::getline(lines, data);
    events.push_back({std::stoll(id.substr(4)), kind.substr(7), data.substr(6)});
  }
  return events;
}

const std::set<std::string> ends{"done", "failed", "cancelled"};

}  // namespace

TEST_CASE("the stream of a calibration tells its life from the beginning", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  const std::string path = api.submit(drop_study());
  const Wire wire = follow(api, path + "/events");
  const std::string text = wire.until("\nevent: calibration.done\n", "\n\n");
  CHECK(has(text, "Content-Type: text/event-stream"));
  CHECK(has(text, "retry: 2000"));
  const auto events = events_in(text);
  REQUIRE(events.size() >= 4);
  CHECK(events[0].kind == "calibration.queued");
  CHECK(events[1].kind == "calibration.running");
  CHECK(events.back().kind == "calibration.done");
  CHECK(Json::parse(events.back().data)["misfit"].is_number());
  const auto progress =
      std::ranges::find(events, std::string("calibration.progress"), &Event::kind);
  REQUIRE(progress != events.end());
  CHECK(Json::parse(progress->data)["progress"]["evaluations_planned"].is_number());
  for (const Event& event : events) {
    CHECK("/v1/calibrations/" + Json::parse(event.data)["calibration"].dump() == path);
  }
}

TEST_CASE("a stream that is cut goes on where it was, whatever the cut", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  const std::string path = api.submit(drop_study());
  api.wait(path, ends);
  const std::string whole_page =
      api.get("/v1/events?limit=200", {{"Accept", "application/json"}}).body;
  const Json items = Json::parse(whole_page)["items"];
  const std::string last = "\nid: " + items.back()["id"].dump();
  const auto read_from = [&](std::int64_t id) {
    const Wire wire = follow(api, "/v1/events", "Last-Event-ID: " + std::to_string(id) + "\r\n");
    return events_in(wire.until(last, "\n\n"));
  };
  const auto all = read_from(0);
  REQUIRE(all.size() == items.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    CHECK(all[i].id == static_cast<std::int64_t>(i + 1));
    CHECK(Json::parse(all[i].data) == items[i]["data"]);
  }
  for (std::size_t cut = 1; cut < all.size(); ++cut) {
    const auto rest = read_from(all[cut - 1].id);
    CHECK(rest == std::vector<Event>(all.begin() + static_cast<std::ptrdiff_t>(cut), all.end()));
  }
}

TEST_CASE("the stream of all begins with what comes next", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  api.wait(api.submit(drop_study()), ends);
  const Wire wire = follow(api, "/v1/events");
  CHECK(has(wire.until("retry: 2000\n\n"), "200"));
  const std::string path = api.submit(drop_study());
  const std::string text = wire.until("calibration.done", "\n\n");
  for (const Event& event : events_in("\n" + text)) {
    CHECK("/v1/calibrations/" + Json::parse(event.data)["calibration"].dump() == path);
  }
}

TEST_CASE("events are also had in pages, and their numbers are checked", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  const httplib::Headers page{{"Accept", "application/json"}};
  const std::string path = api.submit(drop_study());
  api.wait(path, ends);
  const Json first = Json::parse(api.get(path + "/events?limit=2", page).body);
  REQUIRE(first["items"].size() == 2);
  const Json second =
      Json::parse(api.get(path + "/events?limit=1&after=" + first["next"].dump(), page).body);
  CHECK(second["items"][0]["id"].get<int>() > first["items"][1]["id"].get<int>());
  const httplib::Headers page_after{{"Accept", "application/json"},
                                    {"Last-Event-ID", first["next"].dump()}};
  CHECK(Json::parse(api.get(path + "/events?limit=1", page_after).body) == second);
  CHECK(api.get("/v1/calibrations/99/events", page).status == 404);
  CHECK(api.get("/v1/events?after=-1", page).status == 400);
  CHECK(api.get("/v1/events", {{"Last-Event-ID", "x"}}).status == 400);
}
