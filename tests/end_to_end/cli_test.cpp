// The program as a user meets it: words in, text and exit code out.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace fs = std::filesystem;
using Catch::Contains;
using repose::tests::repose_program;

namespace {

struct Ran {
  std::string output;
  int exit_code = -1;
};

/// Runs the program through the shell; standard error goes where `errors` says.
Ran run(const std::string& arguments, const std::string& errors = "/dev/null") {
  const std::string command = "'" + repose_program + "' " + arguments + " 2>" + errors;
  Ran ran;
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::array<char, 4096> buffer{};
  for (std::size_t count = 0; (count = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    ran.output.append(buffer.data(), count);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) ran.exit_code = WEXITSTATUS(status);
  return ran;
}

/// A folder of its own, removed at the end.
struct TemporaryFolder {
  fs::path path;
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "repose_cli_XXXXXX").string();
    path = mkdtemp(pattern.data());
  }
  ~TemporaryFolder() { fs::remove_all(path); }
};

constexpr const char* small_study = R"({
  "name": "drop on a plate",
  "materials": {
    "grain": {"density": {"value": 1228, "unit": "kg/m3"}, "diameter": {"value": 6.496, "unit": "mm"},
              "shear_modulus": {"value": 1.04, "unit": "MPa"}, "poisson_ratio": {"value": 0.25, "unit": "1"}},
    "wall": {"shear_modulus": {"value": 1.04, "unit": "MPa"}, "poisson_ratio": {"value": 0.25, "unit": "1"}}
  },
  "free": [{"field": "restitution.coefficient", "between": ["grain", "wall"],
            "lower": 0.3, "upper": 0.9, "unit": "1"}],
  "measurements": [{"experiment": "drop", "observable": "restitution", "value": 0.6, "unit": "1",
                    "standard_error": 0.01, "source": "a test"}],
  "budget": {"evaluations": 24, "fidelity": "draft"},
  "seed": 1
})";

}  // namespace

TEST_CASE("evaluate --json prints exactly one JSON object", "[end_to_end]") {
  const Ran ran = run("evaluate drop --fidelity draft --json");
  CHECK(ran.exit_code == 0);
  const auto json = nlohmann::json::parse(ran.output);  // throws where more than one follows
  CHECK(json.at("experiment") == "drop");
  CHECK(json.at("fidelity") == "draft");
  CHECK(json.at("observations").at(0).at("name") == "restitution");
  CHECK(json.at("observations").at(0).at("value").get<double>() == Approx(0.6).margin(0.02));
  CHECK(json.at("observations").at(0).at("standard_error").is_null());
  CHECK(json.at("particle_steps_per_second").get<double>() > 0.0);
  CHECK(json.at("replicates") == 1);
  CHECK(json.contains("engine_version"));
}

TEST_CASE("a study that is not published is refused with those that are", "[end_to_end]") {
  const TemporaryFolder folder;
  const Ran ran = run("study boac2011 --db " + (folder.path / "a.db").string(), "&1");
  CHECK(ran.exit_code == 2);
  CHECK_THAT(ran.output, Contains("did you mean \"boac2010\"?"));
}

TEST_CASE("an experiment is explained with its drawing and settings", "[end_to_end]") {
  const Ran ran = run("explain heap");
  CHECK(ran.exit_code == 0);
  CHECK_THAT(ran.output, Contains("disc_diameter") && Contains("heap_angle") && Contains("o o o"));
  CHECK_THAT(run("explain").output, Contains("kettle") && Contains("compression"));
}

TEST_CASE("the same evaluation gives the same bits", "[end_to_end]") {
  const auto observed = [] {
    const Ran ran = run("evaluate drop --fidelity draft --seed 5 --json");
    return nlohmann::json::parse(ran.output).at("observations").dump();
  };
  CHECK(observed() == observed());
}

TEST_CASE("a parameter that is set changes what is observed", "[end_to_end]") {
  const Ran ran =
      run("evaluate drop --fidelity draft --json --set restitution.coefficient:grain-wall=0.3");
  const auto json = nlohmann::json::parse(ran.output);
  CHECK(json.at("observations").at(0).at("value").get<double>() == Approx(0.3).margin(0.02));
}

TEST_CASE("an experiment that fails is a failure in JSON and exit code 1", "[end_to_end]") {
  const Ran ran = run("evaluate kettle --fidelity draft --json --setting diameter=10mm");
  CHECK(ran.exit_code == 1);
  const auto json = nlohmann::json::parse(ran.output);
  CHECK(json.at("failure").at("kind") == "bad_input");
  CHECK_FALSE(json.contains("observations"));
}

TEST_CASE("bad usage is exit code 2 with a sentence on standard error", "[end_to_end]") {
  for (const char* words : {"evaluate",
                            "evaluate kettl",
                            "evaluate drop --fidelity huge",
                            "explain kettl",
                            "evaluate drop --set nonsense",
                            "evaluate drop --replicates 0",
                            "evaluate drop --seed -1",
                            "evaluate drop --seed 99999999999999999999",
                            "evaluate drop --setting height=1m --setting height=2m",
                            "evaluate drop --set restitution.coefficient:grain-wall=0.3 "
                            "--set restitution.coefficient:wall-grain=0.4",
                            "calibrate /nowhere/study.json",
                            "fly"}) {
    INFO(words);
    const Ran silent = run(words);
    CHECK(silent.exit_code == 2);
    CHECK(silent.output.empty());
    CHECK_THAT(run(words, "&1").output, Contains("repose: "));
  }
}

TEST_CASE("a file or address that cannot be used is exit code 2 and says why", "[end_to_end]") {
  const TemporaryFolder folder;
  const std::string file = (folder.path / "no_database.db").string();
  std::ofstream(file)
      << "rubbish, long enough to be no header of a database at all, not even nearly so\n";
  const Ran rubbish =
      run("calibrate '" REPOSE_SOURCE_DIR "/schemas/examples/valid/drop-minimal.json' --db " + file,
          "&1");
  CHECK(rubbish.exit_code == 2);
  CHECK_THAT(rubbish.output, Contains(file));
  const std::string database = (folder.path / "a.db").string();
  const std::string serve = "serve --host 192.0.2.1 --db " + database;
  const Ran open = run(serve, "&1");
  CHECK(open.exit_code == 2);
  CHECK_THAT(open.output, Contains("there are no tokens yet") && Contains("repose token create"));
  const Ran proxied = run("serve --port 0 --name dem.example --db " + database, "&1");
  CHECK(proxied.exit_code == 2);
  CHECK_THAT(proxied.output, Contains("dem.example can be reached by others"));
  const Ran control = run("token create \"$(printf 'a\\033[2J')\" --db " + database, "&1");
  CHECK(control.exit_code == 2);
  CHECK_THAT(control.output, Contains("one line"));
  REQUIRE(run("token create any --scope submit --db " + database).exit_code == 0);
  const Ran address = run(serve, "&1");
  CHECK(address.exit_code == 2);
  CHECK_THAT(address.output, Contains("cannot listen on 192.0.2.1") && Contains("--port"));
}

TEST_CASE("the engine's speed is measured and told as one JSON object", "[end_to_end]") {
  const Ran ran = run("bench engine --scene static --grains 300 --rounds 2 --json");
  CHECK(ran.exit_code == 0);
  const auto scenes = nlohmann::json::parse(ran.output)["scenes"];
  REQUIRE(scenes.size() == 1);
  CHECK(scenes[0]["scene"] == "static");
  CHECK(scenes[0]["grains"] == 300);
  CHECK(scenes[0]["contacts_per_grain"] > 1.5);
  CHECK(scenes[0]["slowest"] <= scenes[0]["particle_steps_per_second"]);
  CHECK(run("bench engine --scene static --grains 7001").exit_code == 2);
  CHECK(run("bench engine --scene silo").exit_code == 2);
}

TEST_CASE("the calibrator's need is told as JSON beside that of a baseline", "[end_to_end]") {
  const Ran ran = run("bench calibrator --case A --seeds 1 --methods repose,isres --json");
  CHECK(ran.exit_code == 0);
  const auto answer = nlohmann::json::parse(ran.output);
  CHECK(answer["case"] == "A");
  REQUIRE(answer["methods"].size() == 2);
  CHECK(answer["methods"][0]["name"] == "repose");
  CHECK(answer["methods"][0]["median"] <= 40);
  CHECK(answer["methods"][0]["p90"] == answer["methods"][0]["median"]);
  CHECK(answer["methods"][0]["share_within_40"] == 1.0);
  CHECK(answer["methods"][1]["name"] == "isres");
  const Ran two = run("bench calibrator --case A --case D --seeds 1 --methods bobyqa --json");
  const auto list = nlohmann::json::parse(two.output);
  REQUIRE(list.size() == 2);
  CHECK(list[1]["methods"][0]["median"].is_null());  // eight parameters: never within 400
  CHECK(run("bench calibrator --case F").exit_code == 2);
  CHECK(run("bench calibrator --methods powell").exit_code == 2);
}

TEST_CASE("help and version are no errors", "[end_to_end]") {
  CHECK(run("--help").exit_code == 0);
  CHECK(run("evaluate --help").exit_code == 0);
  CHECK_THAT(run("--version").output, Contains("repose 0."));
}

TEST_CASE("a tolerance of what is not measured is refused, never left out", "[end_to_end]") {
  const TemporaryFolder folder;
  const std::string database = " --db " + (folder.path / "a.db").string();
  const std::string study = (folder.path / "study.json").string();
  std::ofstream(study) << small_study;
  REQUIRE(run("calibrate --no-pictures " + study + database).exit_code == 0);
  CHECK(run("compare 1 --tolerance drop.restitution=0.2" + database).exit_code == 0);
  const auto refused = [&](const std::string& words) {
    const Ran ran = run(words + database, "&1");
    CHECK(ran.exit_code == 2);
    return ran.output;
  };
  for (const char* command : {"compare 1", "diagnose 1"}) {
    CHECK_THAT(refused(std::string(command) + " --tolerance drop.rest=0.2"),
               Contains("there is no such observable") && Contains("drop.restitution"));
    CHECK_THAT(refused(std::string(command) + " --tolerance drop.restitution="),
               Contains("EXPERIMENT.OBSERVABLE=SHARE"));
    CHECK_THAT(refused(std::string(command) +
                       " --tolerance drop.restitution=0.1 --tolerance drop.restitution=0.2"),
               Contains("given before"));
  }
  CHECK_THAT(refused("compare 1 --tolerance heap.heap_angle=0.1"),
             Contains("the study measures drop.restitution"));
}

TEST_CASE("where output cannot be written is told before the work, not after", "[end_to_end]") {
  const TemporaryFolder folder;
  const std::string study = (folder.path / "study.json").string();
  std::ofstream(study) << small_study;
  const std::string database = (folder.path / "a.db").string();
  const std::string nowhere = (folder.path / "nowhere" / "r.html").string();
  const auto refused = [](const std::string& words) {
    const Ran ran = run(words, "&1");
    CHECK(ran.exit_code == 2);
    return ran.output;
  };
  CHECK_THAT(refused("calibrate " + study + " --db " + database + " --report " + nowhere),
             Contains(nowhere + " cannot be written: there is no folder"));
  CHECK_FALSE(fs::exists(database));
  REQUIRE(run("calibrate --no-pictures " + study + " --db " + database).exit_code == 0);
  CHECK_THAT(refused("report 1 --db " + database + " --output " + folder.path.string()),
             Contains("is a folder"));
  CHECK_THAT(refused("lineage 1 --db " + database + " --report " + nowhere), Contains(nowhere));
  for (const char* words : {"list", "trends", "bench fidelity", "study boac2010 --quick"}) {
    INFO(words);
    CHECK_THAT(refused(words + std::string(" --db ") + study + "/a.db"),
               Contains(study + "/a.db") && !Contains("filesystem error"));
  }
  const std::string in_file = study + "/frames";
  for (const char* words : {"evaluate drop --frames ", "trends --output ", "schema --write "}) {
    INFO(words);
    CHECK_THAT(refused(words + in_file + (words[0] == 't' ? " --db " + database : "")),
               Contains("cannot make the folder " + study));
  }
}

TEST_CASE("reports of two databases in one folder leave each other alone", "[end_to_end]") {
  const TemporaryFolder folder;
  const std::string study = (folder.path / "study.json").string();
  std::ofstream(study) << small_study;
  for (const char* name : {"r.db", "s.db"}) {
    const std::string database = (folder.path / name).string();
    REQUIRE(run("calibrate --no-pictures " + study + " --db " + database).exit_code == 0);
  }
  CHECK(fs::exists(folder.path / "r-report-1.html"));
  CHECK(fs::exists(folder.path / "s-report-1.html"));
}

TEST_CASE("tokens are made for a database of ours, or for one that is to come", "[end_to_end]") {
  const TemporaryFolder folder;
  const std::string file = (folder.path / "a.db").string();
  const std::string database = " --db " + file;
  for (const char* words : {"token list", "token revoke abc"}) {
    const Ran ran = run(words + database, "&1");
    CHECK(ran.exit_code == 2);
    CHECK_THAT(ran.output, Contains("there is no database " + file));
  }
  CHECK(fs::is_empty(folder.path));
  for (const char* name : {"''", "'  '", "\"$(printf 'a\\nb')\""}) {
    INFO(name);
    const Ran ran = run("token create " + std::string(name) + database, "&1");
    CHECK(ran.exit_code == 2);
    CHECK_THAT(ran.output, Contains("a token's name is one line"));
  }
  CHECK(fs::is_empty(folder.path));
  const Ran first = run("token create ada" + database, "&1");
  CHECK(first.exit_code == 0);
  CHECK_THAT(first.output, Contains("no database " + file + " yet") && Contains("rps_"));
  CHECK_THAT(run("token list" + database).output, Contains("ada"));
  std::ofstream(file) << "no database, but a text that is long enough to be looked into, and more";
  CHECK(run("token create bob" + database).exit_code == 2);
}

TEST_CASE("a command that there is not is named, with the nearest", "[end_to_end]") {
  const auto refused = [](const std::string& words) {
    const Ran ran = run(words, "&1");
    CHECK(ran.exit_code == 2);
    return ran.output;
  };
  for (const char* words : {"calibrat study.json", "calibrat --help", "help calibrat"}) {
    CHECK_THAT(refused(words), Contains("'calibrat' (did you mean \"calibrate\"?)"));
  }
  CHECK_THAT(refused("schedule ad"),
             Contains("'ad' (did you mean \"add\"?)") && Contains("`repose schedule --help`"));
  CHECK_THAT(refused("--verson"), Contains("--verson (did you mean \"--version\"?)"));
  CHECK_THAT(refused(""), Contains("which command?") && !Contains("answer"));
  CHECK(run("help").output == run("--help").output);
  CHECK(run("help schedule add").output == run("schedule add --help").output);
  CHECK(run("help schedule add").exit_code == 0);
}

TEST_CASE("frames are written with an index", "[end_to_end][slow]") {
  const TemporaryFolder folder;
  const Ran ran = run("evaluate drop --fidelity draft --json --frames " + folder.path.string());
  CHECK(ran.exit_code == 0);
  CHECK(fs::exists(folder.path / "frames.pvd"));
  CHECK(fs::exists(folder.path / "frame_00000.vtp"));
}

TEST_CASE("a study is calibrated, listed, shown and reported", "[end_to_end][slow]") {
  const TemporaryFolder folder;
  const std::string study = (folder.path / "study.json").string();
  const std::string database = " --db " + (folder.path / "repose.db").string();
  std::ofstream(study) << small_study;
  const Ran calibrated = run("calibrate " + study + database);
  INFO(calibrated.output);
  CHECK(calibrated.exit_code == 0);
  CHECK_THAT(calibrated.output, Contains("The measurement is met within"));
  CHECK_THAT(calibrated.output, Contains("restitution.coefficient:grain-wall"));
  CHECK(fs::exists(folder.path / "repose-report-1.html"));

  CHECK_THAT(run("list" + database).output, Contains("drop on a plate"));
  CHECK(nlohmann::json::parse(run("show 1 --json" + database).output).at("state").is_string());
  const std::string report = (folder.path / "r.html").string();
  CHECK(run("report 1 --no-pictures --output " + report + database).exit_code == 0);
  CHECK(fs::file_size(report) > 10000);

  const Ran again = run("calibrate " + study + database + " --json --no-pictures");
  CHECK(again.exit_code == 0);
  CHECK(nlohmann::json::parse(again.output).contains("fit"));
}
