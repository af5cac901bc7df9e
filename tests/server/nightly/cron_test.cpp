#include "server/nightly/cron.hpp"

#include <array>
#include <string>

#include <catch2/catch.hpp>

#include "engine/random.hpp"

using namespace repose::server;
using namespace std::chrono;
using namespace std::chrono_literals;

namespace {

Cron cron(const std::string& text) {
  auto parsed = parse_cron(text);
  REQUIRE(parsed);
  return *parsed;
}

local_seconds at(year_month_day day, seconds time = 0s) { return local_days(day) + time; }

}  // namespace

TEST_CASE("a cron expression names its minutes, and the first from a time on", "[server]") {
  const local_seconds from = at(2026y / March / 3d, 2h + 31min);  // a Tuesday
  CHECK(first_from(cron("30 2 * * *"), from) == at(2026y / March / 4d, 2h + 30min));
  CHECK(first_from(cron("31 2 * * *"), from) == from);
  CHECK(first_from(cron("31 2 * * *"), from + 1s) == at(2026y / March / 4d, 2h + 31min));
  CHECK(first_from(cron("*/20 * * * *"), from) == at(2026y / March / 3d, 2h + 40min));
  CHECK(first_from(cron("5-59/25 3 * * *"), from) == at(2026y / March / 3d, 3h + 5min));
  CHECK(first_from(cron("0 22 * * mon-fri"), from) == at(2026y / March / 3d, 22h));
  CHECK(first_from(cron("0 0 * * 7"), from) == at(2026y / March / 8d));
  CHECK(first_from(cron("0 0 * * SUN"), from) == at(2026y / March / 8d));
  CHECK(first_from(cron("0 0 29 feb *"), from) == at(2028y / February / 29d));
  CHECK(first_from(cron("0 12 1,15 */6 *"), from) == at(2026y / July / 1d, 12h));
}

TEST_CASE("where day and weekday are both given, either is enough", "[server]") {
  const local_seconds from = at(2026y / March / 3d);
  CHECK(first_from(cron("0 0 13 * fri"), from) == at(2026y / March / 6d));
  CHECK(first_from(cron("0 0 5 * fri"), from) == at(2026y / March / 5d));
  // A field that begins with * restricts, but is not one of the two.
  CHECK(first_from(cron("0 0 */2 * sat"), from) == at(2026y / March / 7d));
}

TEST_CASE("a day that never comes is none", "[server]") {
  CHECK_FALSE(first_from(cron("0 0 30 2 *"), at(2026y / March / 3d)).has_value());
  CHECK_FALSE(first_from(cron("0 0 31 4,6,9,11 *"), at(2026y / March / 3d)).has_value());
}

TEST_CASE("what is no cron expression is refused, with the field that is wrong", "[server]") {
  const auto error = [](const std::string& text) {
    const auto parsed = parse_cron(text);
    return parsed ? std::string() : parsed.error();
  };
  CHECK_THAT(error("30 2 * *"), Catch::Contains("found 4"));
  CHECK_THAT(error(""), Catch::Contains("found 0"));
  CHECK_THAT(error("@daily"), Catch::Contains("found 1"));
  CHECK_THAT(error("60 2 * * *"), Catch::Contains("minute is \"60\""));
  CHECK_THAT(error("0 24 * * *"), Catch::Contains("hour is \"24\""));
  CHECK_THAT(error("0 0 0 * *"), Catch::Contains("day of month is \"0\""));
  CHECK_THAT(error("0 0 * foo *"), Catch::Contains("month is \"foo\""));
  CHECK_THAT(error("0 0 * * 8"), Catch::Contains("day of week is \"8\""));
  for (const char* bad : {"*/0 * * * *",
                          "5-1 * * * *",
                          "1, * * * *",
                          "-1 * * * *",
                          "1-2-3 * * * *",
                          "1//2 * * * *",
                          "+5 * * * *",
                          "99999999999 * * * *",
                          "0x5 * * * *"}) {
    INFO(bad);
    CHECK_FALSE(error(bad).empty());
  }
}

TEST_CASE("any text is parsed or refused, and what is parsed comes at its minutes", "[server]") {
  constexpr std::string_view letters = "0123456789*/-, sunmonjafeb\t";
  constexpr std::array<std::string_view, 8> likely{
      "*", "*/2", "1", "5", "1-5", "3,7", "2-6/2", "0"};
  int parsed = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    repose::engine::Random random(seed, repose::engine::Purpose::trial, 1);
    std::string text;
    for (int field = 0; field < 5; ++field) {
      if (field > 0) text += ' ';
      if (random.uniform() < 0.8) {
        text += likely[random.bits() % likely.size()];
        continue;
      }
      const std::uint64_t length = 1 + random.bits() % 3;
      for (std::uint64_t i = 0; i < length; ++i) text += letters[random.bits() % letters.size()];
    }
    const auto result = parse_cron(text);
    if (!result) continue;
    ++parsed;
    const auto first = first_from(*result, at(2026y / March / 3d));
    if (!first) continue;
    const local_days day = floor<days>(*first);
    const hh_mm_ss time(*first - day);
    INFO(text);
    CHECK(result->minutes[static_cast<std::size_t>(time.minutes().count())]);
    CHECK(result->hours[static_cast<std::size_t>(time.hours().count())]);
    CHECK(result->months[static_cast<unsigned>(year_month_day(day).month())]);
  }
  CHECK(parsed > 100);
}
