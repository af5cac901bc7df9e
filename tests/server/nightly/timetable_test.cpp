#include "server/nightly/timetable.hpp"

#include <map>
#include <string>

#include <catch2/catch.hpp>

using namespace repose::server;
using namespace std::chrono;
using namespace std::chrono_literals;

namespace {

Timetable timetable(const std::string& cron, const std::string& zone) {
  return {.cron = *parse_cron(cron), .zone = *TimeZone::find(zone)};
}

sys_seconds utc(year_month_day day, seconds time = 0s) { return sys_days(day) + time; }

}  // namespace

TEST_CASE("a zone is found by its name, and no other text is one", "[server]") {
  CHECK(TimeZone::find("Europe/Berlin")->name() == "Europe/Berlin");
  for (const char* name : {"", "Berlin", "Europe/berlin", "../../etc/passwd", "Mars/Olympus"}) {
    CHECK_FALSE(TimeZone::find(name).has_value());
  }
}

TEST_CASE("a time that the clocks skip comes after the gap, once", "[server]") {
  // 29 March 2026, Berlin: 02:00 is followed by 03:00, which is 01:00 UTC.
  const Timetable berlin = timetable("30 2 * * *", "Europe/Berlin");
  const auto gap = next_after(berlin, utc(2026y / March / 28d, 12h));
  CHECK(gap == utc(2026y / March / 29d, 1h));
  CHECK(next_after(berlin, *gap) == utc(2026y / March / 30d, 30min));
  // Several skipped times come together.
  const Timetable quarters = timetable("*/15 2 * * *", "Europe/Berlin");
  CHECK(next_after(quarters, utc(2026y / March / 29d)) == utc(2026y / March / 29d, 1h));
  CHECK(next_after(quarters, utc(2026y / March / 29d, 1h)) == utc(2026y / March / 30d));
}

TEST_CASE("a time that the clocks show twice comes the first time, once", "[server]") {
  // 25 October 2026, Berlin: 02:30 is 00:30 and 01:30 UTC.
  const Timetable berlin = timetable("30 2 * * *", "Europe/Berlin");
  const auto first = next_after(berlin, utc(2026y / October / 24d, 12h));
  CHECK(first == utc(2026y / October / 25d, 30min));
  CHECK(next_after(berlin, *first) == utc(2026y / October / 26d, 1h + 30min));
  CHECK(next_after(berlin, utc(2026y / October / 25d, 1h)) ==
        utc(2026y / October / 26d, 1h + 30min));
}

TEST_CASE("every local date of three years has one night, in zones of every kind", "[server]") {
  for (const char* zone : {"Europe/Berlin",
                           "America/New_York",
                           "Australia/Lord_Howe",  // half an hour
                           "America/Havana",       // midnight is skipped
                           "Africa/Casablanca",    // back and forth around Ramadan
                           "Asia/Kathmandu",
                           "UTC"}) {
    for (const char* cron : {"30 2 * * *", "0 0 * * *", "59 23 * * *"}) {
      INFO(zone << " " << cron);
      const Timetable one = timetable(cron, zone);
      std::map<local_days, int> nights;
      sys_seconds now = utc(2025y / January / 1d, 12h);
      const sys_seconds end = utc(2028y / January / 1d, 12h);
      for (auto next = next_after(one, now); *next < end; next = next_after(one, now)) {
        REQUIRE(*next > now);
        ++nights[floor<days>(one.zone.local(*next))];
        now = *next;
      }
      for (const auto& [day, count] : nights) REQUIRE(count == 1);
      CHECK(nights.size() == 1095);
    }
  }
}

TEST_CASE("of the nights that were missed the last is caught up, unless it is too late",
          "[server]") {
  const Timetable berlin = timetable("30 2 * * *", "Europe/Berlin");
  const sys_seconds made = utc(2026y / June / 1d, 12h);
  CHECK_FALSE(due(berlin, 1, made, made + 12h).has_value());
  const auto on_time = due(berlin, 1, made, utc(2026y / June / 2d, 31min));
  REQUIRE(on_time);
  CHECK(on_time->planned == utc(2026y / June / 2d, 30min));
  CHECK(on_time->missed == 0);
  CHECK_FALSE(on_time->too_late);
  const auto late = due(berlin, 1, made, utc(2026y / June / 5d, 10h));
  REQUIRE(late);
  CHECK(late->planned == utc(2026y / June / 5d, 30min));
  CHECK(late->missed == 3);
  CHECK_FALSE(late->too_late);
  CHECK(due(berlin, 1, made, utc(2026y / June / 5d, 13h))->too_late);
  CHECK_FALSE(due(berlin, 1, late->planned, utc(2026y / June / 5d, 13h)).has_value());
}

TEST_CASE("jitter delays a night by the same time whenever it is asked", "[server]") {
  Timetable berlin = timetable("30 2 * * *", "Europe/Berlin");
  berlin.jitter = 20min;
  const sys_seconds made = utc(2026y / June / 1d, 12h);
  const sys_seconds planned = utc(2026y / June / 2d, 30min);
  seconds least = 20min, most = 0s;
  for (std::int64_t schedule = 1; schedule <= 100; ++schedule) {
    const seconds later = delay(berlin, schedule, planned);
    CHECK(later == delay(berlin, schedule, planned));
    least = std::min(least, later);
    most = std::max(most, later);
    if (later > 0s) CHECK_FALSE(due(berlin, schedule, made, planned + later - 1s).has_value());
    CHECK(due(berlin, schedule, made, planned + later)->planned == planned);
  }
  CHECK(most <= 20min);
  CHECK(least < 2min);
  CHECK(most > 18min);
}
