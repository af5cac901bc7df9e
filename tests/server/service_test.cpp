#include "server/service.hpp"

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <future>
#include <memory>
#include <mutex>
#include <thread>

#include <catch2/catch.hpp>

#include "db/store.hpp"
#include "server/json/report_json.hpp"
#include "server/json/text.hpp"
#include "tests/support/example.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace repose;
using namespace repose::server;
using repose::tests::example;
using repose::tests::TemporaryFolder;

namespace {

std::string drop_study() { return example("valid/drop-minimal.json"); }

ServiceOptions in(const TemporaryFolder& folder) {
  ServiceOptions options;
  options.database = folder / "a.db";
  options.workers = 2;
  return options;
}

CalibrationDocument read(const Answer<std::string>& answer) {
  REQUIRE(answer.has_value());
  const auto document = parse_document(*answer);
  REQUIRE(document.has_value());
  return *document;
}

/// Calibrates; also counts the trials that were run and those that the store had.
CalibrationDocument calibrate(Service& service, int& run, int& stored) {
  CalibrationEvents events;
  run = stored = 0;
  events.trial = [&](std::size_t, std::size_t, bool was_stored) { ++(was_stored ? stored : run); };
  return read(service.calibrate(drop_study(), {}, events));
}

}  // namespace

TEST_CASE("a calibration ends done, with a fit", "[server]") {
  const TemporaryFolder folder;
  Service service(in(folder));
  int run = 0, stored = 0;
  const auto document = calibrate(service, run, stored);
  CHECK(document.state == "done");
  REQUIRE(document.fit.has_value());
  CHECK(document.fit->predictions.size() == 1);
  CHECK(run > 5);
  CHECK_FALSE(document.finished_at.empty());
}

TEST_CASE("a second calibration of the same study runs nothing anew and finds the same",
          "[server]") {
  const TemporaryFolder folder;
  Service service(in(folder));
  int run = 0, stored = 0;
  const auto first = calibrate(service, run, stored);
  const auto second = calibrate(service, run, stored);
  CHECK(run == 0);
  CHECK(stored > 5);
  CHECK(second.id != first.id);
  CHECK(second.fit->misfit == first.fit->misfit);
  CHECK(second.fit->best == first.fit->best);
}

TEST_CASE("a calibration that was stopped is taken up again", "[server]") {
  const TemporaryFolder folder;
  std::int64_t id = 0;
  {
    Service service(in(folder));
    std::stop_source source;
    CalibrationEvents events;
    events.trial = [&source](std::size_t, std::size_t, bool) { source.request_stop(); };
    const auto document = read(service.calibrate(drop_study(), source.get_token(), events));
    CHECK(document.state == "queued");
    id = document.id;
  }
  Service service(in(folder));
  int run = 0, stored = 0;
  const auto document = calibrate(service, run, stored);
  CHECK(document.id == id);
  CHECK(document.state == "done");
  CHECK(stored > 0);
}

TEST_CASE("a submitted calibration is run in the background", "[server]") {
  const TemporaryFolder folder;
  std::int64_t id = 0;
  {
    Service service(in(folder));  // does not run jobs
    const auto document = read(service.submit(drop_study()));
    CHECK(document.state == "queued");
    id = document.id;
  }
  ServiceOptions options = in(folder);
  options.run_jobs = true;
  Service service(options);
  std::string state;
  for (int look = 0; look < 100000 && state != "done"; ++look) {
    state = read(service.calibration(id)).state;
  }
  CHECK(state == "done");
}

TEST_CASE("a study with mistakes is refused with all of them", "[server]") {
  const TemporaryFolder folder;
  Service service(in(folder));
  const auto answer = service.submit(R"({"name": 3, "fre": []})");
  REQUIRE_FALSE(answer.has_value());
  CHECK(answer.error().kind == Refusal::Kind::invalid);
  CHECK(answer.error().problems.size() > 2);
  CHECK(parse_items(service.calibrations(10, std::nullopt).document).empty());
}

TEST_CASE("a study whose grain is of a name that is not kept is told so before all else",
          "[server]") {
  const TemporaryFolder folder;
  Service service(in(folder));
  Json study = Json::parse(drop_study());
  const Json content{{"title", "ours"}, {"grain", study["materials"]["grain"]}};
  REQUIRE(service.put_material("our-beads", to_text(content), false));
  const auto refusal = [&](const char* material) {
    study["material"] = material;
    const auto refused = service.submit(to_text(study));
    REQUIRE_FALSE(refused);
    REQUIRE(refused.error().problems.size() > 1);
    CHECK(refused.error().problems[1].pointer == "/materials/grain/density");
    const Problem first = refused.error().problems[0];
    CHECK(first.pointer == "/material");
    return first.message + "; " + first.allowed;
  };
  study["materials"].erase("grain");
  CHECK_THAT(refusal("our-bead"),
             Catch::Contains("did you mean \"our-beads\"?") && Catch::Contains("is kept"));
  CHECK_THAT(refusal("soybeen"), Catch::Contains("did you mean \"soybean\"?"));
  CHECK_THAT(refusal("soybean"),
             Catch::Contains("published") && Catch::Contains("/v1/materials/soybean"));
  study["material"] = "our-beads";
  CHECK(service.submit(to_text(study)));
}

TEST_CASE("a waiting calibration is cancelled at once, a finished one not at all", "[server]") {
  const TemporaryFolder folder;
  Service service(in(folder));
  const auto waiting = read(service.submit(drop_study()));
  CHECK(read(service.cancel(waiting.id)).state == "cancelled");
  const auto again = service.cancel(waiting.id);
  REQUIRE_FALSE(again.has_value());
  CHECK(again.error().kind == Refusal::Kind::wrong_state);
  const auto none = service.cancel(99);
  REQUIRE_FALSE(none.has_value());
  CHECK(none.error().kind == Refusal::Kind::not_found);
}

TEST_CASE("what is stored can be read while a service runs", "[server]") {
  const TemporaryFolder folder;
  Service writer(in(folder));
  int run = 0, stored = 0;
  const auto id = calibrate(writer, run, stored).id;
  ServiceOptions options = in(folder);
  options.read_only = true;
  const Service reader(options);
  CHECK(read(reader.calibration(id)).state == "done");
  CHECK(parse_items(reader.calibrations(10, std::nullopt).document).size() == 1);
  CHECK(reader.best_fits({}).find("\"parameters\":[{") != std::string::npos);
  CHECK(reader.best_fits({.name = "another"}).find("\"items\":[]") != std::string::npos);
  CHECK(reader.evaluations(id, 3, std::nullopt)->next == "2");
  CHECK_THROWS_AS(Service(in(folder)), db::Error);
}

TEST_CASE("a list of fits tells a good one from a bad one, and two materials apart", "[server]") {
  const TemporaryFolder folder;
  Service service(in(folder));
  Json study = Json::parse(drop_study());
  study["material"] = "glass";
  REQUIRE(service.calibrate(to_text(study), {}, {}));
  study["material"] = "steel";
  study["seed"] = 2;
  Json other = study["measurements"][0];  // of another height, and far from what one model has
  other["value"] = 0.3;
  other["settings"] = {{"height", {{"value", 100}, {"unit", "mm"}}}};
  study["measurements"].push_back(other);
  REQUIRE(service.calibrate(to_text(study), {}, {}));
  REQUIRE(service.add_schedule(to_text(Json{{"name", "nightly"},
                                            {"cron", "30 2 * * *"},
                                            {"time_zone", "UTC"},
                                            {"start_from", 1},
                                            {"study", study}})));

  const Json fits = Json::parse(service.fits({}, 10).document)["items"];
  REQUIRE(fits.size() == 2);
  const Json &bad = fits[0], &good = fits[1];
  CHECK(bad["stop"] == "budget");
  CHECK(bad["quality"]["freedom"] == 1);
  CHECK(bad["quality"]["p"] < 0.01);
  CHECK(bad["in_force"] == Json::array());
  CHECK(good["stop"] == "hit");
  CHECK(good["quality"]["p"] > 0.01);
  CHECK(good["in_force"] == Json{1});
  for (const Json& fit : fits) {
    const auto comparison = service.compare(fit["calibration"], {});
    REQUIRE(comparison);
    for (const char* member : {"misfit", "freedom", "p", "fitted_z"}) {
      CHECK(fit["quality"][member] == Json::parse(*comparison)[member]);
    }
  }

  const Json best = Json::parse(service.best_fits({}))["items"];
  REQUIRE(best.size() == 2);
  CHECK(best[0]["name"] == best[1]["name"]);
  CHECK(best[0]["material"] == "glass");
  CHECK(best[0]["quality"] == good["quality"]);
  CHECK(best[0]["in_force"] == Json{1});
  CHECK(best[1]["material"] == "steel");
}

TEST_CASE("a warm start takes over what the store had, and a replay of it the same", "[server]") {
  const TemporaryFolder folder;
  Service service(in(folder));
  int cold = 0, run = 0, stored = 0;
  calibrate(service, cold, stored);
  auto study = repose::server::Json::parse(drop_study());
  study["budget"]["warm_start"] = true;
  study["measurements"][0]["value"] = study["measurements"][0]["value"].get<double>() + 0.03;
  CalibrationEvents events;
  events.trial = [&](std::size_t, std::size_t, bool was_stored) { run += was_stored ? 0 : 1; };
  const auto warm = read(service.calibrate(study.dump(), {}, events));
  CHECK(warm.state == "done");
  CHECK(run < cold);
  CHECK(warm.fit->history.front().stage != "start");
}

TEST_CASE("a free parameter that no measurement feels is named before the search", "[server]") {
  const TemporaryFolder folder;
  Service service(in(folder));
  auto study = repose::server::Json::parse(drop_study());
  // A grain that falls straight on a plate does not slide.
  study["free"].push_back({{"field", "sliding_friction.coefficient"},
                           {"between", {"grain", "wall"}},
                           {"lower", 0.1},
                           {"upper", 0.9},
                           {"unit", "1"}});
  int run = 0;
  CalibrationEvents events;
  events.trial = [&](std::size_t, std::size_t, bool) { ++run; };
  const auto document = read(service.calibrate(study.dump(), {}, events));
  CHECK(document.state == "failed");
  CHECK(document.error.find("no measurement feels sliding_friction.coefficient:grain-wall") !=
        std::string::npos);
  CHECK(run == 0);  // nothing of the search
}

TEST_CASE("a change that is done once does not lock out the look whether the service is ready",
          "[server]") {
  for (int round = 0; round < 3; ++round) {
    const TemporaryFolder folder(TemporaryFolder::fast());
    // Threads that wait for each other for good are left behind with what they hold.
    const auto service = std::make_shared<Service>(in(folder));
    std::vector<std::int64_t> waiting;
    for (int i = 0; i < 100; ++i) waiting.push_back(read(service->submit(drop_study())).id);
    std::promise<bool> ended;
    auto end = ended.get_future();
    std::thread([service, waiting, ended = std::move(ended)]() mutable {
      std::promise<bool> found;
      auto ready = found.get_future();
      service->once("key", "digest", [&]() -> std::optional<std::string> {
        std::promise<void> begun;
        auto begin = begun.get_future();
        std::thread([service, found = std::move(found), begun = std::move(begun)]() mutable {
          begun.set_value();
          found.set_value(service->ready());
        }).detach();
        begin.wait();
        for (const std::int64_t id : waiting) (void)service->cancel(id);
        return std::string("done");
      });
      ended.set_value(ready.get());
    }).detach();
    REQUIRE(end.wait_for(std::chrono::minutes(1)) == std::future_status::ready);
    CHECK(end.get());
  }
}

// Eleven seconds: the host is given time to recover.
TEST_CASE("a calibration at which the host fails waits, and goes on where the host is well again",
          "[server][slow]") {
  const TemporaryFolder folder;
  const auto program = folder / "program";
  std::ofstream(program) << "#!/bin/sh\n'" << repose::tests::repose_program
                         << R"(' answer | sed 's/"engine_version":"/&other-/')"
                         << "\n";
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  {
    ServiceOptions failing = in(folder);
    failing.program = program;
    Service service(failing);
    CHECK_THROWS_WITH(service.calibrate(drop_study(), {}, {}), Catch::Contains("another engine"));
    CHECK(read(service.calibration(1)).state == "queued");
  }
  Service service(in(folder));
  int run = 0, stored = 0;
  const auto document = calibrate(service, run, stored);
  CHECK(document.id == 1);
  CHECK(document.state == "done");
  CHECK(stored == 0);
}
