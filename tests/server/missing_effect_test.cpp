#include "server/missing_effect.hpp"

#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "server/json/lineage_json.hpp"
#include "server/service.hpp"
#include "tests/support/hidden_drop.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace repose;
using namespace repose::server;
using repose::tests::hidden_drop_study;
using repose::tests::TemporaryFolder;

namespace {

using nlohmann::json;

ServiceOptions in(const TemporaryFolder& folder) {
  ServiceOptions options;
  options.database = folder / "a.db";
  options.workers = 2;
  return options;
}

json read(const Answer<std::string>& answer) {
  if (!answer) FAIL(answer.error().message);
  return json::parse(*answer);
}

constexpr double relaxation = 6e-5;  // s

}  // namespace

TEST_CASE("a speed dependence that our own engine hid is added, and the error falls",
          "[server][slow]") {
  const TemporaryFolder folder;
  Service service(in(folder));
  const std::int64_t id = read(service.calibrate(hidden_drop_study(relaxation), {}, {}))["id"];
  const json before = read(service.compare(id, {}));
  CHECK(before["p"] < 0.01);
  CHECK(before["before"].is_null());

  const auto study = service.extension_study(id, "velocity_restitution");
  REQUIRE(study);
  const json child = read(service.calibrate(*study, {}, {}));
  REQUIRE(child["state"] == "done");
  const json after = read(service.compare(child["id"], {}));
  CHECK(after["before"]["misfit"] == before["misfit"]);
  CHECK(after["misfit"].get<double>() < 0.1 * before["misfit"].get<double>());
  CHECK(after["held_out_z"].get<double>() < 0.5 * before["held_out_z"].get<double>());

  const auto lineage = service.lineage(child["id"]);
  REQUIRE(lineage);
  const auto items = parse_lineage(*lineage);
  REQUIRE(items);
  REQUIRE(items->size() == 2);
  CHECK(items->front().calibration == id);
  CHECK(items->back().parent == id);
  CHECK(items->back().effect == "velocity_restitution");
  CHECK(*service.lineage(id) != *lineage);  // another was asked for
  CHECK(path_through(*items, id).size() == 2);
}

TEST_CASE("of four suspects the hidden speed dependence is named, and adding it settles the matter",
          "[server][slow]") {
  const TemporaryFolder folder;
  Service service(in(folder));
  const std::string suspects =
      R"(["velocity_restitution","plastic_restitution","air_drag","twisting_resistance"])";
  constexpr double plausible = 3e-5;  // s; twice as much is beyond what a diagnosis looks for
  const std::int64_t id =
      read(service.calibrate(hidden_drop_study(plausible, suspects), {}, {}))["id"];
  const json told = read(service.diagnose(id, {}, {}, {}))["result"];
  INFO(told["text"]);
  REQUIRE((told["verdict"] == "named" || told["verdict"] == "family"));
  CHECK(told["evaluations"] <= 200);
  REQUIRE(told["refits"].size() > 1);  // the runner-up is shown
  const std::string front = told["refits"][0]["effects"][0]["name"];
  const bool depends_on_speed = front == "velocity_restitution" || front == "plastic_restitution";
  CHECK(depends_on_speed);
  for (const json& effect : told["effects"]) {
    CAPTURE(effect["name"]);
    CHECK((effect["name"] != "twisting_resistance" || effect["status"] == "not_testable"));
  }
  CHECK(told["refits"][0]["fitted_z"].get<double>() < 0.5 * told["fitted_z"].get<double>());

  const auto study = service.extension_study(id, front);
  REQUIRE(study);
  const json child = read(service.calibrate(*study, {}, {}));
  const json after = read(service.compare(child["id"], {}));
  CHECK(after["held_out_z"] < after["before"]["held_out_z"]);
  const json settled = read(service.diagnose(child["id"], {}, {}, {}))["result"];
  CHECK((settled["verdict"] == "adequate" || settled["verdict"] == "not_testable"));
}

TEST_CASE("a diagnosis that was stopped is taken up, and one that is cancelled is not",
          "[server]") {
  const TemporaryFolder folder;
  Service service(in(folder));
  const std::int64_t id = read(service.calibrate(hidden_drop_study(0.0), {}, {}))["id"];
  std::stop_source source;
  DiagnosisEvents events;
  events.trial = [&source](std::size_t, std::size_t, bool) { source.request_stop(); };
  const json stopped = read(service.diagnose(id, {}, source.get_token(), events));
  CHECK(stopped["state"] == "queued");
  const json done = read(service.diagnose(id, {}, {}, {}));
  CHECK(done["id"] == stopped["id"]);
  CHECK(done["state"] == "done");
  CHECK(done["result"]["verdict"] == "adequate");

  const json waiting = read(service.submit_diagnosis(id, R"({"tolerances":{}})"));
  CHECK(waiting["state"] == "queued");
  CHECK(read(service.submit_diagnosis(id, "{}"))["id"] == waiting["id"]);
  CHECK(read(service.cancel_diagnosis(waiting["id"]))["state"] == "cancelled");
  const auto again = service.cancel_diagnosis(waiting["id"]);
  REQUIRE_FALSE(again);
  CHECK(again.error().kind == Refusal::Kind::wrong_state);
}

TEST_CASE("what cannot be diagnosed or added is refused in words, without a run", "[server]") {
  const TemporaryFolder folder;
  Service service(in(folder));
  const json queued = read(service.submit(hidden_drop_study(0.0)));
  const auto kind = [](const auto& answer) {
    REQUIRE_FALSE(answer);
    return answer.error().kind;
  };
  CHECK(kind(service.submit_diagnosis(queued["id"], "{}")) == Refusal::Kind::wrong_state);
  CHECK(kind(service.submit_diagnosis(99, "{}")) == Refusal::Kind::not_found);
  CHECK(kind(service.compare(99, {})) == Refusal::Kind::not_found);
  CHECK(kind(service.lineage(99)) == Refusal::Kind::not_found);
  const std::int64_t id = read(service.calibrate(hidden_drop_study(0.0), {}, {}))["id"];
  const auto wrong = service.submit_diagnosis(
      id, R"({"tolerances":{"drop.restituton":0.1,"drop.restitution":2},"tolerance":1})");
  CHECK(kind(wrong) == Refusal::Kind::invalid);
  CHECK(wrong.error().problems.size() == 3);
  const auto unknown = service.extend(id, R"({"effect":"velocity_restituton"})");
  CHECK(kind(unknown) == Refusal::Kind::invalid);
  CHECK(unknown.error().problems.front().message.find("velocity_restitution") != std::string::npos);
  CHECK(kind(service.extend(id, R"({"effect":"restitution"})")) == Refusal::Kind::wrong_state);
  CHECK(kind(service.extend(id, R"({"effect":"moisture_softening"})")) ==
        Refusal::Kind::wrong_state);
  CHECK(kind(service.extend(id, R"({"effect":"air_drag","diagnosis":7})")) ==
        Refusal::Kind::wrong_state);
}

TEST_CASE("a study that extends what is not there is refused", "[server]") {
  const TemporaryFolder folder;
  Service service(in(folder));
  json study = json::parse(hidden_drop_study(0.0));
  const std::int64_t parent = read(service.submit(study.dump()))["id"];
  const auto pointer = [&](std::int64_t calibration, const json& diagnosis) {
    study["extends"] = {{"calibration", calibration}, {"effect", "air_drag"}};
    if (!diagnosis.is_null()) study["extends"]["diagnosis"] = diagnosis;
    const auto answer = service.submit(study.dump());
    return answer ? "" : answer.error().problems.front().pointer;
  };
  CHECK(pointer(99, nullptr) == "/extends/calibration");
  CHECK(pointer(parent, 7) == "/extends/diagnosis");
  CHECK(pointer(parent, nullptr).empty());
}

TEST_CASE("a queued diagnosis is run in the background, and an extension too", "[server]") {
  const TemporaryFolder folder;
  std::int64_t id = 0, diagnosis = 0;
  {
    Service service(in(folder));  // does not run jobs
    id = read(service.calibrate(hidden_drop_study(0.0), {}, {}))["id"];
    diagnosis = read(service.submit_diagnosis(id, "{}"))["id"];
  }
  ServiceOptions options = in(folder);
  options.run_jobs = true;
  Service service(options);
  const auto wait = [](const auto& state_of) {
    std::string state;
    for (int look = 0; look < 1000000 && state != "done" && state != "failed"; ++look) {
      state = state_of();
    }
    return state;
  };
  CHECK(wait([&] { return read(service.diagnosis(diagnosis))["state"]; }) == "done");
  const json child = read(service.extend(id, R"({"effect":"velocity_restitution"})"));
  CHECK(child["study"]["extends"]["diagnosis"] == diagnosis);
  CHECK(wait([&] { return read(service.calibration(child["id"]))["state"]; }) == "done");
}

TEST_CASE("an extension is of what it extends: its material, and its set while it has that",
          "[server]") {
  const TemporaryFolder folder;
  Service service(in(folder));
  json study = json::parse(hidden_drop_study(0.0));
  const json content{{"material", "ball"}, {"measurements", study["measurements"]}};
  REQUIRE(service.put_measurement_set("drops", content.dump(), std::nullopt));
  study.erase("measurements");
  study["measurement_set"] = {{"name", "drops"}};
  const json parent = read(service.calibrate(study.dump(), {}, {}));
  const json drops{{"name", "drops"}, {"version", 1}};
  CHECK(parent["material"] == "ball");
  CHECK(parent["measurement_set"] == drops);
  const auto extended = service.extension_study(parent["id"], "velocity_restitution");
  REQUIRE(extended);
  const json child = read(service.submit(*extended));
  CHECK(child["material"] == "ball");
  CHECK(child["measurement_set"] == drops);
  json changed = json::parse(*extended);
  changed["measurements"][0]["value"] = 0.5;
  const json other = read(service.submit(changed.dump()));
  CHECK(other["material"] == "ball");
  CHECK(other["measurement_set"].is_null());
}

TEST_CASE("a study that is stored with control characters is extended without them", "[server]") {
  const TemporaryFolder folder;
  json study = json::parse(hidden_drop_study(0.0));
  std::string fit;
  {
    Service service(in(folder));
    fit = read(service.calibrate(study.dump(), {}, {}))["fit"].dump();
  }
  std::int64_t id = 0;
  {
    db::Store store(folder / "a.db", db::Access::write);
    study["name"] = "lab\nbox";
    study["measurements"][0]["source"] = "by\u009bhand";
    id = store.add_calibration("lab\nbox", study.dump(), "d", 1);
    REQUIRE(store.start(id, 2));
    REQUIRE(store.finish(id, "done", fit, 0.5, std::nullopt, 3));
  }
  Service service(in(folder));
  const json child = read(service.extend(id, R"({"effect":"velocity_restitution"})"));
  CHECK(child["name"] == "lab box + velocity_restitution");
  CHECK(child["study"]["measurements"][0]["source"] == "by hand");
}
