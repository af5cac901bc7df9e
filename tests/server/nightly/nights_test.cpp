// Night after night with a clock that the test turns: the drop experiment stands for the plant.
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <iomanip>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "db/material_store.hpp"
#include "db/schedule_store.hpp"
#include "engine/random.hpp"
#include "server/json/text.hpp"
#include "server/nightly/time_zone.hpp"
#include "server/service.hpp"
#include "tests/support/captured_log.hpp"
#include "tests/support/example.hpp"
#include "tests/support/hidden_drop.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace repose;
using namespace repose::server;
using namespace std::chrono;
using namespace std::chrono_literals;
using repose::tests::CapturedLog;
using repose::tests::example;
using repose::tests::hidden_drop_study;
using repose::tests::TemporaryFolder;

namespace {

Json drop_study(double restitution, double standard_error = 0.02) {
  Json study = Json::parse(example("valid/drop-minimal.json"));
  study["measurements"][0]["value"] = restitution;
  study["measurements"][0]["standard_error"] = standard_error;
  return study;
}

Json schedule_of(Json study) {
  return {{"name", "drop, nightly"},
          {"cron", "30 2 * * *"},
          {"time_zone", "Europe/Berlin"},
          {"study", std::move(study)}};
}

/// A service whose clock stands where the test puts it.
class Plant {
 public:
  Plant() : service_(std::make_unique<Service>(options())) {}

  Json add(double restitution) {
    const auto answer = service_->add_schedule(to_text(schedule_of(drop_study(restitution))));
    REQUIRE(answer);
    return Json::parse(*answer);
  }
  void measure(double restitution, double standard_error = 0.02) {
    const Json document = schedule_of(drop_study(restitution, standard_error));
    REQUIRE(service_->replace_schedule(1, to_text(document)));
  }
  void run(const std::stop_token& stop = {}, const CalibrationEvents& events = {}) {
    service_->run_nights(false, stop, events);
  }
  Json history() {
    return Json::parse(service_->nights(1, 10000, std::nullopt)->document)["items"];
  }
  Json last() { return history().at(0); }
  Json standing() { return Json::parse(*service_->schedule(1)); }
  Service& service() { return *service_; }
  /// Does that to the store while no service runs.
  void meddle(const std::function<void(db::Store&)>& work) {
    service_.reset();
    {
      db::Store store(folder_ / "a.db", db::Access::write);
      work(store);
    }
    service_ = std::make_unique<Service>(options());
  }
  /// From now on a service that looks at the clock and runs jobs by itself; the clock stands still.
  void work_in_background() {
    service_.reset();
    ServiceOptions working = options();
    working.run_jobs = true;
    service_ = std::make_unique<Service>(working);
  }
  /// Evaluations that were answered, in all.
  std::int64_t answers() { return service_->figures().attempts["answered"]; }

  sys_seconds now = sys_days(2026y / March / 1d) + 12h;

 private:
  ServiceOptions options() {
    ServiceOptions result;
    result.database = folder_ / "a.db";
    result.workers = 1;
    result.clock = [this] { return now.time_since_epoch().count() * 1'000'000; };
    return result;
  }
  TemporaryFolder folder_{TemporaryFolder::fast()};
  std::unique_ptr<Service> service_;
};

}  // namespace

TEST_CASE(
    "the first night fits, a night without news judges nothing, a small change keeps the fit, a "
    "large one moves it",
    "[server]") {
  Plant plant;
  CHECK(plant.add(0.6)["next_at"] == "2026-03-02T01:30:00.000000Z");
  plant.run();
  CHECK(plant.history().empty());  // not yet
  plant.now += 24h;
  plant.run();
  CHECK(plant.last()["outcome"] == "first");
  CHECK(plant.standing()["promoted"]["calibration"] == 1);
  CHECK(plant.standing()["fit"]["parameters"].size() == 1);

  plant.now += 24h;
  plant.run();
  CHECK(plant.last()["outcome"] == "unchanged");
  CHECK(plant.last()["calibration"].is_null());

  plant.measure(0.605);
  plant.now += 24h;
  plant.run();
  CHECK(plant.last()["outcome"] == "kept");
  CHECK(plant.last()["calibration"] == 2);
  CHECK(plant.last()["result"]["incumbent_held"] == true);
  CHECK(plant.last()["result"]["changed"][0]["before"] == 0.6);
  CHECK(plant.standing()["promoted"]["calibration"] == 1);

  plant.measure(0.7);
  plant.now += 24h;
  plant.run();
  CHECK(plant.last()["outcome"] == "moved");
  CHECK(plant.last()["result"]["incumbent_held"] == false);
  CHECK(plant.last()["result"]["promoted"] == true);
  CHECK(plant.standing()["promoted"]["calibration"] == 3);
  const double fitted = plant.standing()["fit"]["parameters"][0]["value"].get<double>();
  CHECK(fitted == Approx(0.7).margin(0.03));
}

TEST_CASE("a measurement that no parameter can meet is a model that is no longer adequate",
          "[server]") {
  Plant plant;
  plant.add(0.6);
  plant.now += 24h;
  plant.run();
  plant.measure(0.1, 0.005);  // the search ends at 0.3
  plant.now += 24h;
  plant.run();
  CHECK(plant.last()["outcome"] == "model_no_longer_adequate");
  CHECK(plant.last()["result"]["promoted"] == false);
  CHECK(plant.standing()["promoted"]["calibration"] == 1);
  // One measurement and one parameter are too little for a diagnosis, and the night says so.
  CHECK_THAT(plant.last()["result"]["reason"].get<std::string>(),
             Catch::Contains("no diagnosis") && Catch::Contains("cannot be tested"));
  // Without news the night after says nothing of the fit in force, which has failed.
  plant.now += 24h;
  plant.run();
  CHECK(plant.last()["outcome"] == "unchanged");
}

TEST_CASE("a first fit that misses its only measurement is not put in force", "[server]") {
  Plant plant;
  plant.add(0.6);
  plant.measure(0.1, 0.005);  // the search ends at 0.3; with twelve evaluations by its budget
  plant.now += 24h;
  plant.run();
  CHECK(plant.last()["outcome"] == "model_no_longer_adequate");
  CHECK(plant.last()["result"]["promoted"] == false);
  CHECK(plant.standing()["promoted"].is_null());
}

TEST_CASE("a night without news keeps no fit where none is in force", "[server][slow]") {
  Plant plant;
  Json study = drop_study(0.6);
  Json other = study["measurements"][0];  // of another height, and far from what one model has
  other["value"] = 0.35;
  other["settings"] = {{"height", {{"value", 100}, {"unit", "mm"}}}};
  study["measurements"].push_back(other);
  REQUIRE(plant.service().add_schedule(to_text(schedule_of(study))));
  for (const char* outcome : {"model_no_longer_adequate", "unchanged"}) {
    plant.now += 24h;
    plant.run();
    CHECK(plant.last()["outcome"] == outcome);
    CHECK(plant.standing()["promoted"].is_null());
  }
}

TEST_CASE("a fit that was in force is put in force again by hand, another one is not", "[server]") {
  Plant plant;
  plant.add(0.6);
  plant.now += 24h;
  plant.run();
  plant.measure(0.7);
  plant.now += 24h;
  plant.run();
  REQUIRE(plant.standing()["promoted"]["calibration"] == 2);
  REQUIRE(plant.service().promote(1, R"({"calibration": 1})"));
  CHECK(plant.standing()["promoted"]["calibration"] == 1);
  CHECK(Json::parse(*plant.service().promotions(1))["items"].size() == 3);
  const auto strange = plant.service().promote(1, R"({"calibration": 77})");
  REQUIRE_FALSE(strange);
  CHECK(strange.error().kind == Refusal::Kind::wrong_state);
  CHECK(plant.service().promote(1, "{}").error().kind == Refusal::Kind::invalid);
  // The next night holds the fit in force against the measurements: it does not hold.
  plant.measure(0.71);
  plant.now += 24h;
  plant.run();
  CHECK(plant.last()["incumbent"] == 1);
  CHECK(plant.last()["outcome"] == "moved");
}

TEST_CASE("a night takes the measurements of a set as they are that night, and tells what it did",
          "[server]") {
  Plant plant;
  const auto put = [&](const char* value) {
    const Json set{{"material", "soybean"},
                   {"measurements",
                    {{{"experiment", "drop"},
                      {"observable", "restitution"},
                      {"value", std::stod(value)},
                      {"unit", "1"},
                      {"standard_error", 0.02}}}}};
    REQUIRE(plant.service().put_measurement_set("plant", to_text(set), std::nullopt));
  };
  put("0.6");
  Json study = drop_study(0.6);
  study.erase("measurements");
  study["measurement_set"] = {{"name", "plant"}};
  REQUIRE(plant.service().add_schedule(to_text(schedule_of(study))));
  for (const auto& [value, outcome] :
       {std::pair{"0.6", "first"}, std::pair{"0.6", "unchanged"}, std::pair{"0.7", "moved"}}) {
    put(value);
    plant.now += 24h;
    plant.run();
    CHECK(plant.last()["outcome"] == outcome);
  }
  study["measurement_set"] = {{"name", "another"}};
  CHECK(plant.service().add_schedule(to_text(schedule_of(study))).error().problems[0].pointer ==
        "/study/measurement_set");
  std::vector<std::string> kinds;
  const Json told = Json::parse(plant.service().events(std::nullopt, 200, 0)->document);
  for (const Json& event : told["items"]) {
    const auto kind = event["kind"].get<std::string>();
    if (kind.starts_with("night") || kind == "promotion") kinds.push_back(kind);
  }
  CHECK(kinds == std::vector<std::string>{
                     "night.first", "promotion", "night.unchanged", "night.moved", "promotion"});
}

TEST_CASE("a night that was cut off is taken up where it was", "[server]") {
  Plant plant;
  plant.add(0.6);
  plant.now += 24h;
  std::stop_source source;
  CalibrationEvents events;
  events.trial = [&](std::size_t, std::size_t, bool) { source.request_stop(); };
  plant.run(source.get_token(), events);
  CHECK(plant.last()["state"] == "running");
  plant.run();
  CHECK(plant.history().size() == 1);
  CHECK(plant.last()["outcome"] == "first");
  CHECK(plant.last()["calibration"] == 1);
}

TEST_CASE("a night that comes while the last one runs is skipped, and so is one that is too late",
          "[server]") {
  Plant plant;
  plant.add(0.6);
  plant.now += 24h;
  std::stop_source source;
  CalibrationEvents events;
  events.trial = [&](std::size_t, std::size_t, bool) { source.request_stop(); };
  plant.run(source.get_token(), events);
  plant.now += 24h;
  plant.run(source.get_token(), events);
  CHECK(plant.last()["state"] == "skipped");
  CHECK_THAT(plant.last()["result"]["reason"].get<std::string>(), Catch::Contains("still running"));
  plant.run();
  plant.now += 96h + 6h;  // 18:00
  plant.run();
  CHECK(plant.history().size() == 3);
  CHECK(plant.last()["planned_at"] == "2026-03-07T01:30:00.000000Z");
  CHECK_THAT(plant.last()["result"]["reason"].get<std::string>(), Catch::Contains("too late"));
}

TEST_CASE("a schedule whose study cannot be read any more fails night after night, and says why",
          "[server]") {
  Plant plant;
  Json study = drop_study(0.6);
  const Json grain{{"title", "ours"}, {"grain", study["materials"]["grain"]}};
  study["materials"].erase("grain");
  study["material"] = "ours";
  REQUIRE(plant.service().put_material("ours", to_text(grain), false));
  REQUIRE(plant.service().add_schedule(to_text(schedule_of(study))));
  // As long as the schedule is there, its grain is.
  const auto refused = plant.service().remove_material("ours");
  REQUIRE_FALSE(refused);
  CHECK(refused.error().kind == Refusal::Kind::wrong_state);
  CHECK_THAT(refused.error().message, Catch::Contains("schedule 1"));
  plant.meddle([](db::Store& store) { db::MaterialStore(store).remove("ours"); });
  CHECK(plant.standing()["next_at"] == "2026-03-02T01:30:00.000000Z");
  for (std::size_t night = 1; night <= 2; ++night) {
    plant.now += 24h;
    plant.run();
    CHECK(plant.history().size() == night);
    CHECK(plant.last()["state"] == "failed");
    CHECK_THAT(plant.last()["result"]["reason"].get<std::string>(),
               Catch::Contains("cannot be read any more"));
  }
  REQUIRE(plant.service().remove_schedule(1));
  REQUIRE(plant.service().put_material("ours", to_text(grain), false));
  CHECK(plant.service().remove_material("ours"));
}

TEST_CASE("a schedule that fails is told in the log, and keeps no other one from beginning",
          "[server]") {
  Plant plant;
  plant.meddle([](db::Store& store) { db::ScheduleStore(store).add("of no form", "{}", 0); });
  const auto second = plant.service().add_schedule(to_text(schedule_of(drop_study(0.6))));
  REQUIRE(second);
  plant.now += 24h;
  const CapturedLog log;
  CHECK_THROWS_WITH(plant.run(), Catch::Contains("not every night"));
  const Json nights = Json::parse(plant.service().nights(2, 10, std::nullopt)->document)["items"];
  REQUIRE(nights.size() == 1);
  CHECK(nights[0]["outcome"] == "first");
  CHECK_THAT(log.text(), Catch::StartsWith("repose: schedule 1 failed: its times cannot be read"));
}

TEST_CASE("new measurements do not lose the night that waits for its delay, other times do",
          "[server]") {
  Plant plant;
  Json schedule = schedule_of(drop_study(0.6));
  schedule["jitter_minutes"] = 60;
  REQUIRE(plant.service().add_schedule(to_text(schedule)));
  plant.now = sys_days(2026y / March / 2d) + 1h + 30min;
  plant.run();
  CHECK(plant.history().empty());  // not before its delay
  schedule["study"] = drop_study(0.7);
  REQUIRE(plant.service().replace_schedule(1, to_text(schedule)));
  plant.run();
  REQUIRE(plant.history().size() == 1);
  CHECK(plant.last()["planned_at"] == "2026-03-02T01:30:00.000000Z");
  CHECK(plant.last()["result"]["changed"][0]["now"] == 0.7);
  plant.now += 24h;
  schedule["cron"] = "0 2 * * *";
  REQUIRE(plant.service().replace_schedule(1, to_text(schedule)));
  plant.now += 1h;
  plant.run();
  CHECK(plant.history().size() == 1);
}

TEST_CASE("a night whose model is no longer adequate ends with its diagnosis", "[server][slow]") {
  constexpr double hidden = 6e-5;  // s; velocity_restitution.relaxation
  const Json schedule = schedule_of(Json::parse(hidden_drop_study(hidden)));
  Plant whole;
  REQUIRE(whole.service().add_schedule(to_text(schedule)));
  whole.now += 24h;
  whole.run();
  CHECK(whole.last()["outcome"] == "model_no_longer_adequate");
  REQUIRE(whole.last()["diagnosis"] == 1);
  CHECK(Json::parse(*whole.service().diagnosis(1))["state"] == "done");

  // One that is cancelled runs nothing more, and the night ends all the same.
  Plant cut;
  REQUIRE(cut.service().add_schedule(to_text(schedule)));
  cut.now += 24h;
  cut.work_in_background();
  while (!cut.service().diagnosis(1)) std::this_thread::yield();
  REQUIRE(cut.service().cancel_diagnosis(1));
  while (cut.last()["state"] == "running") std::this_thread::yield();
  CHECK(cut.last()["outcome"] == "model_no_longer_adequate");
  CHECK(cut.last()["diagnosis"] == 1);
  CHECK(Json::parse(*cut.service().diagnosis(1))["state"] == "cancelled");
  CHECK(cut.answers() < whole.answers());
}

TEST_CASE("control characters are refused in what is sent, and stop no night of what is stored",
          "[server]") {
  Plant plant;
  plant.add(0.6);
  Json document = schedule_of(drop_study(0.6));
  document["name"] = document["study"]["name"] = "lab\nbox";
  document["study"]["material"] = "glass\x1b[2J";
  const auto refused = plant.service().add_schedule(to_text(document));
  REQUIRE_FALSE(refused);
  std::set<std::string> places;
  for (const Problem& problem : refused.error().problems) places.insert(problem.pointer);
  CHECK(places == std::set<std::string>{"/name", "/study/name", "/study/material"});
  CHECK_FALSE(plant.service().replace_schedule(1, to_text(document)));
  CHECK_FALSE(plant.service().submit(to_text(document["study"])));
  plant.meddle([&](db::Store& store) {
    db::ScheduleStore(store).replace(1, "lab\nbox", to_text(document), 1);
  });
  plant.now += 24h;
  plant.run();
  CHECK(plant.last()["outcome"] == "first");
}

TEST_CASE("two schedules of one study and one time have nights of their own", "[server]") {
  Plant plant;
  plant.add(0.6);
  plant.add(0.6);
  plant.now += 24h;
  plant.run();
  for (const int schedule : {1, 2}) {
    const auto standing = Json::parse(*plant.service().schedule(schedule));
    CHECK(standing["last_night"]["outcome"] == "first");
    CHECK(standing["last_night"]["calibration"] == schedule);
    CHECK(standing["promoted"]["calibration"] == schedule);
  }
}

TEST_CASE("a removed schedule begins no more nights, and its history stays", "[server]") {
  Plant plant;
  plant.add(0.6);
  plant.now += 24h;
  plant.run();
  REQUIRE(plant.service().remove_schedule(1));
  plant.now += 24h;
  plant.run();
  CHECK(plant.history().size() == 1);
  CHECK(plant.standing()["next_at"].is_null());
  CHECK_FALSE(plant.service().remove_schedule(1));
  CHECK(Json::parse(plant.service().schedules())["items"].empty());
}

// Sixty nights over one clock change; four hundred over three (minutes) where REPOSE_SOAK is set.
TEST_CASE(
    "night after night over clock changes: one a date, the shift found, nothing alarmed before it",
    "[server][slow]") {
  const bool soak = std::getenv("REPOSE_SOAK") != nullptr;
  const int nights = soak ? 400 : 60;
  const int shifted_from = soak ? 250 : 40;
  Plant plant;
  plant.add(0.6);
  const auto zone = *TimeZone::find("Europe/Berlin");
  repose::engine::Random random(5, repose::engine::Purpose::trial);
  for (int night = 0; night < nights; ++night) {
    const double truth = night < shifted_from ? 0.6 : 0.56;
    plant.measure(truth + 0.02 * random.normal());
    // Four looks at the clock a day; every 40 nights the machine is off until the next noon.
    const bool off = night % 40 == 39;
    for (int look = 0; look < 4; ++look) {
      plant.now += 6h;
      if (!off || look == 3) plant.run();
    }
  }
  std::set<local_days> dates;
  int alarms_before = 0, first_alarm = nights;
  std::map<std::string, int> outcomes;
  const Json history = plant.history();
  REQUIRE(history.size() == static_cast<std::size_t>(nights));
  for (int night = 0; night < nights; ++night) {
    const Json& row = history[static_cast<std::size_t>(nights - 1 - night)];
    CHECK(row["state"] == "done");
    ++outcomes[row["outcome"].get<std::string>()];
    std::istringstream text(row["planned_at"].get<std::string>().substr(0, 19));
    std::tm utc{};
    text >> std::get_time(&utc, "%Y-%m-%dT%H:%M:%S");
    const local_seconds local = zone.local(sys_seconds(seconds(timegm(&utc))));
    dates.insert(floor<days>(local));
    const auto time = local - floor<days>(local);
    CHECK((time == 2h + 30min || time == 3h));  // 3:00 where 2:30 is skipped
    if (row["result"]["alarms"].empty()) continue;
    if (night < shifted_from) ++alarms_before;
    if (night >= shifted_from) first_alarm = std::min(first_alarm, night);
  }
  CHECK(dates.size() == static_cast<std::size_t>(nights));
  CHECK(alarms_before == 0);                // stated: one in a thousand nights
  CHECK(first_alarm - shifted_from <= 14);  // two standard errors
  CHECK(outcomes["first"] == 1);
  CHECK(outcomes["kept"] > nights / 2);
  CHECK(outcomes["moved"] > 0);
  CHECK(outcomes.size() == 3);
}

TEST_CASE("a schedule starts from a fit of its own experiments and free parameters alone",
          "[server]") {
  Plant plant;
  REQUIRE(plant.service().calibrate(to_text(drop_study(0.6)), {}, {}));
  Json own = schedule_of(drop_study(0.7));
  own["start_from"] = 1;
  CHECK(plant.service().add_schedule(to_text(own)));
  Json other = own;
  other["study"] = Json::parse(hidden_drop_study(0.0));
  other["study"]["free"][0]["field"] = "sliding_friction.coefficient";
  other["study"]["free"][0]["lower"] = 0.1;
  const auto refused = plant.service().add_schedule(to_text(other));
  REQUIRE_FALSE(refused);
  CHECK(refused.error().kind == Refusal::Kind::invalid);
  CHECK(refused.error().problems.front().pointer == "/start_from");
}
