// A calibration that is killed again and again ends with the fit of one that was left alone.
#include <array>
#include <filesystem>
#include <fstream>
#include <signal.h>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "server/json/report_json.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using repose::tests::repose_program;
using repose::tests::TemporaryFolder;

namespace {

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The minimal study with impacts resolved so finely that an evaluation takes some tenths of a
/// second.
std::filesystem::path slow_study(const TemporaryFolder& folder) {
  std::string text = read(REPOSE_SOURCE_DIR "/schemas/examples/valid/drop-minimal.json");
  const std::string before = "\"experiment\": \"drop\"";
  const auto at = text.find(before);
  REQUIRE(at != std::string::npos);
  text.insert(at + before.size(),
              ", \"settings\": {\"steps_per_impact\": {\"value\": 10000, \"unit\": \"1\"}}");
  auto path = folder / "study.json";
  std::ofstream(path) << text;
  return path;
}

pid_t start(const std::filesystem::path& study,
            const std::filesystem::path& database,
            const std::filesystem::path& output) {
  std::string command = "exec '" + repose_program + "' calibrate " + study.string() + " --db " +
                        database.string() + " --no-pictures --json > " + output.string() +
                        " 2>/dev/null";
  std::string shell = "/bin/sh", flag = "-c";
  std::array<char*, 4> arguments{shell.data(), flag.data(), command.data(), nullptr};
  pid_t child = 0;
  REQUIRE(posix_spawn(&child, "/bin/sh", nullptr, nullptr, arguments.data(), environ) == 0);
  return child;
}

/// Everything of the answer that must not depend on when it was made.
std::string fit_of(const std::filesystem::path& output) {
  const std::string text = read(output);
  const auto at = text.find("\"fit\":");
  REQUIRE(at != std::string::npos);
  return text.substr(at);
}

std::size_t rows_stored(const std::filesystem::path& database) {
  std::error_code none;
  const auto size = std::filesystem::file_size(database.string() + "-wal", none);
  return none ? 0 : size;
}

}  // namespace

TEST_CASE("kill -9 at any moment costs no evaluation and changes no bit of the fit",
          "[end_to_end][slow]") {
  const TemporaryFolder folder;
  const auto study = slow_study(folder);
  int status = 0;
  waitpid(start(study, folder / "whole.db", folder / "whole.json"), &status, 0);
  REQUIRE(status == 0);

  const auto database = folder / "killed.db";
  int kills = 0;
  for (int moment = 1; moment <= 5; ++moment) {
    const pid_t child = start(study, database, folder / "killed.json");
    // Wait for the log to grow by a little more each time, then kill.
    const std::size_t before = rows_stored(database);
    const std::size_t wanted = before + 9000U * static_cast<std::size_t>(moment);
    while (waitpid(child, &status, WNOHANG) == 0) {
      if (rows_stored(database) < wanted) continue;
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      ++kills;
      break;
    }
  }
  CHECK(kills > 0);
  waitpid(start(study, database, folder / "killed.json"), &status, 0);
  REQUIRE(status == 0);
  CHECK(fit_of(folder / "killed.json") == fit_of(folder / "whole.json"));
}
