// A user's nights from the command line: schedule, run, look back, go back; export, back up,
// restore.
#include <array>
#include <cstdio>
#include <fstream>
#include <string>
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "server/service.hpp"
#include "tests/support/example.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Contains;
using Json = nlohmann::json;
using repose::server::Service;
using repose::server::ServiceOptions;
using repose::tests::example;
using repose::tests::repose_program;
using repose::tests::TemporaryFolder;

namespace {

/// Runs the program through the shell; its output, and its exit code at the end.
std::string run(const std::string& arguments, int wanted = 0) {
  const std::string command = "'" + repose_program + "' " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::array<char, 4096> buffer{};
  std::string output;
  for (std::size_t count = 0; (count = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    output.append(buffer.data(), count);
  }
  const int status = pclose(pipe);
  INFO(arguments << "\n" << output);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == wanted);
  return output;
}

/// For a service that looks into the same database; while it lives, the database is its own.
ServiceOptions options(const TemporaryFolder& folder) {
  ServiceOptions result;
  result.database = folder / "a.db";
  return result;
}

std::string study(const TemporaryFolder& folder, double restitution) {
  Json document = Json::parse(example("valid/drop-minimal.json"));
  document["measurements"][0]["value"] = restitution;
  const auto path = folder / "study.json";
  std::ofstream(path) << document;
  return path.string();
}

}  // namespace

TEST_CASE("nights are scheduled, run, looked up and undone from the command line", "[end_to_end]") {
  const TemporaryFolder folder;
  const std::string db = " --db " + (folder / "a.db").string();
  const std::string night = "nightly --once --all" + db;
  CHECK_THAT(
      run("schedule add " + study(folder, 0.6) + " --cron '0 25 * * *' --time-zone Mars" + db, 2),
      Contains("/cron") && Contains("/time_zone"));
  CHECK_THAT(run("schedule add " + study(folder, 0.6) + " --time-zone Europe/Berlin" + db),
             Contains("30 2 * * * in Europe/Berlin") && Contains("no fit yet"));
  CHECK_THAT(run(night), Contains("first"));
  CHECK_THAT(run("schedule show 1" + db),
             Contains("in force    calibration 1") &&
                 Contains("restitution.coefficient:grain-wall") && !Contains("- to -"));

  CHECK_THAT(run("schedule add --replace 1 --jitter-minutes 5 " + study(folder, 0.7) + db),
             Contains("30 2 * * * in Europe/Berlin"));
  CHECK_THAT(run("schedule add --replace 1 --cron '0 3 * * *' " + study(folder, 0.7) + db),
             Contains("0 3 * * * in Europe/Berlin"));
  const Json replaced = Json::parse(run("schedule show 1 --json" + db));
  CHECK(replaced["jitter_minutes"] == 5);
  CHECK(replaced["name"] == "one grain dropped");
  run("schedule add --replace 9 " + study(folder, 0.7) + db, 2);
  run("schedule add --replace 0 " + study(folder, 0.7) + db, 2);
  CHECK_THAT(run(night), Contains("moved"));
  const Json history = Json::parse(run("schedule history 1 --json" + db));
  REQUIRE(history["items"].size() == 2);
  CHECK(history["items"][0]["outcome"] == "moved");
  CHECK(history["items"][0]["result"]["promoted"] == true);
  CHECK_THAT(run("schedule promote 1 1" + db), Contains("calibration 1 since"));
  CHECK_THAT(run("schedule promote 1 9" + db, 2), Contains("none of the schedule's"));

  CHECK_THAT(run("schedule remove 1" + db), Contains("removed"));
  run(night);
  CHECK(Json::parse(run("schedule history 1 --json" + db))["items"].size() == 2);
}

TEST_CASE("a study that names a material and a set is taken as it is sent to the service",
          "[end_to_end]") {
  const TemporaryFolder folder;
  const std::string db = " --db " + (folder / "a.db").string();
  Json document = Json::parse(example("valid/drop-minimal.json"));
  const auto keep = [&](double restitution) {
    document["measurements"][0]["value"] = restitution;
    const Json set{{"material", "our-beads"}, {"measurements", document["measurements"]}};
    Service service(options(folder));
    REQUIRE(service.put_measurement_set("may", set.dump(), std::nullopt).has_value());
  };
  const Json beads{{"title", "beads"}, {"grain", document["materials"]["grain"]}};
  REQUIRE(Service(options(folder)).put_material("our-beads", beads.dump(), false).has_value());
  keep(0.6);
  Json named = document;
  named.erase("measurements");
  named["materials"].erase("grain");
  named["material"] = "our-beads";
  named["measurement_set"] = {{"name", "may"}};
  const std::string path = (folder / "named.json").string();
  std::ofstream(path) << named;

  run("calibrate " + path + db + " --no-pictures --report " + (folder / "report.html").string());
  {
    const Service service(options(folder));
    const Json fits = Json::parse(service.fits({.material = "our-beads"}, 1).document);
    REQUIRE(fits["items"].size() == 1);
    CHECK(fits["items"][0]["provenance"]["measurement_set"]["name"] == "may");
  }
  const std::string night = "nightly --once --all" + db;
  run("schedule add " + path + db);
  CHECK_THAT(run(night), Contains("first"));
  keep(0.7);
  CHECK_THAT(run(night),
             Contains("moved"));  // each night takes the measurements that are kept then

  named["measurement_set"]["name"] = "june";
  std::ofstream(path) << named;
  for (const char* words : {"calibrate ", "schedule add "}) {
    CHECK_THAT(run(words + path + db, 2), Contains("no measurement set 'june'"));
  }
}

TEST_CASE("a calibration that waits is told, and ended, from the command line", "[end_to_end]") {
  const TemporaryFolder folder;
  const std::string db = " --db " + (folder / "a.db").string();
  REQUIRE(Service(options(folder)).submit(example("valid/drop-minimal.json")).has_value());
  CHECK_THAT(run("show 1" + db), Contains("repose cancel 1" + db));
  CHECK_THAT(run("cancel 1" + db), Contains("Calibration 1 is cancelled"));
  CHECK_THAT(run("show 1" + db), Contains("(cancelled)") && !Contains("repose cancel"));
  CHECK_THAT(run("cancel 1" + db, 2), Contains("has ended: it is cancelled"));
  CHECK_THAT(run("cancel 9" + db, 2), Contains("no calibration 9"));
  CHECK_THAT(run("cancel 9 --diagnosis" + db, 2), Contains("no diagnosis 9"));
  CHECK_THAT(run("cancel 1 --db " + (folder / "none.db").string(), 2), Contains("no database"));
}

TEST_CASE("a fit is exported, and the database backed up, examined and restored", "[end_to_end]") {
  const TemporaryFolder folder;
  const std::string db = " --db " + (folder / "a.db").string();
  const std::string copy = (folder / "copy.db").string();
  run("calibrate " + study(folder, 0.6) + db + " --no-pictures --report " +
      (folder / "report.html").string());
  CHECK_THAT(run("export 1 --format liggghts" + db), Contains("pair_style gran model hertz"));
  CHECK(Json::parse(run("export 1" + db))["fit"]["parameters"].size() == 1);
  CHECK_THAT(run("export 2 --format csv" + db, 2), Contains("no calibration 2"));
  CHECK_THAT(run("backup " + copy + db), Contains("copy.db"));
  CHECK_THAT(run("doctor" + db), Contains("is sound"));
  CHECK_THAT(run("restore " + copy + db), Contains(".replaced-1"));
  CHECK_THAT(run("show 1" + db), Contains("restitution"));
  CHECK_THAT(run("backup " + copy + db, 2), Contains("there already"));
  const std::string empty = (folder / "empty.db").string();
  std::ofstream{empty};
  CHECK_THAT(run("restore " + empty + db, 2), Contains("holds no database of this program"));
  CHECK_THAT(run("show 1" + db), Contains("restitution"));
}
