#include "server/json/schedule_json.hpp"

#include <algorithm>
#include <set>

#include <catch2/catch.hpp>

#include "server/json/text.hpp"
#include "tests/support/example.hpp"

using namespace repose::server;

namespace {

Json study() { return Json::parse(repose::tests::example("valid/drop-minimal.json")); }

/// No study of these tests names a set.
repose::engine::Result<std::string, Problems> as_it_is(std::string_view study) {
  return std::string(study);
}

std::set<std::string> problems(const Json& document) {
  std::set<std::string> pointers;
  const auto result = parse_schedule(to_text(document), as_it_is);
  if (result) return pointers;
  for (const Problem& problem : result.error()) {
    CHECK(!problem.message.empty());
    CHECK(!problem.allowed.empty());
    pointers.insert(problem.pointer);
  }
  return pointers;
}

}  // namespace

TEST_CASE("a schedule is read, and what is printed of it reads back the same", "[server]") {
  const Json document{{"name", "nightly"},
                      {"cron", "30 2 * * mon-fri"},
                      {"time_zone", "America/Chicago"},
                      {"jitter_minutes", 20},
                      {"start_from", 3},
                      {"study", study()}};
  const auto schedule = parse_schedule(to_text(document), as_it_is);
  REQUIRE(schedule);
  CHECK(schedule->timetable.jitter == std::chrono::minutes(20));
  CHECK(schedule->timetable.catch_up == std::chrono::hours(12));
  CHECK(schedule->start_from == 3);
  const std::string printed = print_schedule(*schedule);
  const auto again = parse_schedule(printed, as_it_is);
  REQUIRE(again);
  CHECK(print_schedule(*again) == printed);
  CHECK(again->study == schedule->study);
}

TEST_CASE("all problems of a schedule are told at once, those of its study in their places",
          "[server]") {
  Json bad_study = study();
  bad_study["free"][0]["lower"] = 0.95;
  bad_study.erase("name");
  CHECK(problems({{"cron", "61 * * * *"},
                  {"time_zone", "Nowhere/Town"},
                  {"jitter_minutes", -1},
                  {"catch_up_hours", "12"},
                  {"start_from", 0},
                  {"night", true},
                  {"study", bad_study}}) == std::set<std::string>{"/name",
                                                                  "/cron",
                                                                  "/time_zone",
                                                                  "/jitter_minutes",
                                                                  "/catch_up_hours",
                                                                  "/start_from",
                                                                  "/night",
                                                                  "/study/name",
                                                                  "/study/free/0/lower"});
  CHECK(
      problems({{"name", "n"}, {"cron", "0 0 30 2 *"}, {"time_zone", "UTC"}, {"study", study()}}) ==
      std::set<std::string>{"/cron"});
  CHECK(problems("text") == std::set<std::string>{""});
}

TEST_CASE("what a night followed reads back as it was printed", "[server]") {
  NightReport report;
  report.followed = {
      {"drop.restitution",
       {0.6, 0.02},
       {.points = 3, .centre = 0.61, .precision = 7500.0, .level = -0.25, .limit = 1.1}}};
  const auto read = parse_followed(print_night_report({}, report));
  REQUIRE(read.size() == 1);
  CHECK(read[0].name == "drop.restitution");
  CHECK(read[0].estimate.value == 0.6);
  CHECK(read[0].drift.points == 3);
  CHECK(read[0].drift.precision == 7500.0);
  CHECK(read[0].drift.level == -0.25);
  CHECK_FALSE(read[0].drift.alarm);
  CHECK(parse_followed("no json").empty());
}
