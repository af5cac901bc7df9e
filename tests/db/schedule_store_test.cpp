#include "db/schedule_store.hpp"

#include <set>

#include <catch2/catch.hpp>

#include "db/event_store.hpp"
#include "db/sqlite.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace repose::db;
using repose::tests::TemporaryFolder;

TEST_CASE("a schedule is added, replaced and removed, and its row stays", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  ScheduleStore schedules(store);
  const auto id = schedules.add("one", "{}", 10);
  CHECK(schedules.replace(id, "two", "{\"a\":1}", 20));
  CHECK(schedules.schedules().size() == 1);
  CHECK(schedules.schedule(id)->name == "two");
  CHECK(schedules.schedule(id)->replaced_at == 20);
  CHECK(schedules.remove(id, 30));
  CHECK_FALSE(schedules.remove(id, 40));
  CHECK_FALSE(schedules.replace(id, "three", "{}", 40));
  CHECK(schedules.schedules().empty());
  CHECK(schedules.schedule(id)->removed_at == 30);
  CHECK_FALSE(schedules.schedule(id + 1).has_value());
}

TEST_CASE("the same night begins once, and ends once with its promotion", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  ScheduleStore schedules(store);
  const auto id = schedules.add("one", "{}", 10);
  const auto calibration = store.add_calibration("n", "{}", "d", 11);
  const auto night = schedules.begin_night(id, 100, 101);
  REQUIRE(night);
  CHECK_FALSE(schedules.begin_night(id, 100, 102).has_value());
  CHECK(schedules.running_nights().size() == 1);
  schedules.set_night_calibration(*night, calibration, std::nullopt, "[1]");
  const NightEnd end{.state = "done", .outcome = "first", .result = "{}", .promotion = "why"};
  CHECK(schedules.end_night(*night, end, 200));
  CHECK_FALSE(schedules.end_night(*night, end, 201));
  CHECK(schedules.running_nights().empty());
  const auto record = schedules.night(*night);
  CHECK(record->outcome == "first");
  CHECK(record->finished_at == 200);
  CHECK(schedules.night_of(calibration)->id == *night);
  CHECK(record->continues == "[1]");
  REQUIRE(schedules.promotions(id).size() == 1);
  CHECK(schedules.promotions(id)[0].calibration == calibration);
  CHECK(schedules.promotions(id)[0].night == night);
  schedules.promote(id, calibration, "again", 300);
  CHECK(schedules.promotions(id)[0].reason == "again");
}

TEST_CASE("a fit is in force where it is the last that a schedule promoted", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  ScheduleStore schedules(store);
  const auto one = store.add_calibration("n", "{}", "d", 1);
  const auto two = store.add_calibration("n", "{}", "e", 1);
  const auto a = schedules.add("a", "{}", 10);
  const auto b = schedules.add("b", "{}", 10);
  const auto c = schedules.add("c", "{}", 10);
  schedules.promote(a, two, "", 11);
  schedules.promote(a, one, "", 12);
  schedules.promote(b, one, "", 13);
  schedules.promote(c, two, "", 14);
  using InForce = std::map<std::int64_t, std::vector<std::int64_t>>;
  CHECK(schedules.in_force() == InForce{{one, {a, b}}, {two, {c}}});
  schedules.remove(c, 20);
  CHECK(schedules.in_force() == InForce{{one, {a, b}}});
}

TEST_CASE("the events of a night and of a promotion name their schedule", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  ScheduleStore schedules(store);
  schedules.add("another", "{}", 10);
  const auto id = schedules.add("one", "{}", 10);
  schedules.begin_night(id, 50, 50);
  const auto night = schedules.begin_night(id, 100, 101);
  const auto calibration = store.add_calibration("n", "{}", "d", 11);
  schedules.set_night_calibration(*night, calibration, std::nullopt, std::nullopt);
  const std::string result = R"({"alarms":["density"]})";
  schedules.end_night(
      *night, {.state = "done", .outcome = "moved", .result = result, .promotion = "why"}, 200);
  schedules.promote(id, calibration, "by hand", 300);
  const auto events = EventStore(store).events(std::nullopt, 1, 10);  // after the calibration's own
  REQUIRE(events.size() == 4);
  std::multiset<std::string> kinds;
  for (const EventRecord& event : events) {
    INFO(event.kind);
    kinds.insert(event.kind);
    CHECK(event.schedule == id);
    CHECK(event.calibration == calibration);
    if (event.id != events.back().id) CHECK(event.night == night);
    const bool of_night = event.kind != "promotion";
    CHECK(event.detail == (of_night ? std::optional(result) : std::nullopt));
  }
  CHECK(kinds ==
        std::multiset<std::string>{"night.drift", "night.moved", "promotion", "promotion"});
  CHECK_FALSE(events.back().night);  // nobody's night led to it
}

TEST_CASE("nights are listed newest first, page by page", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  ScheduleStore schedules(store);
  const auto id = schedules.add("one", "{}", 10);
  const auto other = schedules.add("other", "{}", 10);
  for (int night = 1; night <= 5; ++night) schedules.begin_night(id, night, night);
  schedules.begin_night(other, 1, 1);
  const auto page = schedules.nights(id, 3, std::nullopt);
  REQUIRE(page.size() == 3);
  CHECK(page[0].planned_at == 5);
  CHECK(schedules.nights(id, 3, page[2].id).size() == 2);
}

TEST_CASE("a finished night and a promotion cannot be changed, even by hand", "[db]") {
  const TemporaryFolder folder;
  {
    Store store(folder / "a.db", Access::write);
    ScheduleStore schedules(store);
    const auto night = schedules.begin_night(schedules.add("one", "{}", 10), 1, 1);
    schedules.set_night_calibration(
        *night, store.add_calibration("n", "{}", "d", 11), std::nullopt, std::nullopt);
    schedules.end_night(
        *night, {.state = "done", .outcome = "first", .result = "{}", .promotion = "why"}, 2);
  }
  Connection connection(folder / "a.db", Connection::Mode::write);
  CHECK_THROWS_AS(connection.run("UPDATE night SET outcome = 'kept'"), Error);
  CHECK_THROWS_AS(connection.run("UPDATE promotion SET reason = 'x'"), Error);
}
