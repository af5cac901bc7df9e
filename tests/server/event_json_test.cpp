#include "server/json/event_json.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace repose;
using Json = nlohmann::ordered_json;

namespace {

Json data_of(const db::EventRecord& event) { return Json::parse(server::print_event_data(event)); }

}  // namespace

TEST_CASE("the event of a night says of which schedule it is, and what the night came to",
          "[json]") {
  db::EventRecord event;
  event.kind = "night.moved";
  event.calibration = 3;
  event.schedule = 4;
  event.night = 5;
  event.detail = R"({"reason":"better"})";
  CHECK(
      data_of(event) ==
      Json{{"calibration", 3}, {"schedule", 4}, {"night", 5}, {"result", {{"reason", "better"}}}});
}

TEST_CASE("the event of a calibration that goes on has its progress", "[json]") {
  db::EventRecord event;
  event.kind = "calibration.progress";
  event.calibration = 3;
  event.name = "beans";
  event.detail = R"({"stage":"search"})";
  CHECK(data_of(event) ==
        Json{{"calibration", 3}, {"name", "beans"}, {"progress", {{"stage", "search"}}}});
}
