// A calibration that is killed again and again ends with the fit of one that was left alone.
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <signal.h>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "db/sqlite.hpp"
#include "db/store.hpp"
#include "server/jobs/clock.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using repose::db::Access;
using repose::db::Connection;
using repose::db::Statement;
using repose::db::Store;
using repose::server::microseconds_now;
using repose::tests::repose_program;
using repose::tests::TemporaryFolder;

namespace {

constexpr std::int64_t workers = 2;

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
            const std::filesystem::path& output,
            const std::filesystem::path& errors = "/dev/null") {
  std::string command = "exec '" + repose_program + "' calibrate " + study.string() + " --db " +
                        database.string() + " --workers " + std::to_string(workers) +
                        " --no-pictures --json > " + output.string() + " 2> " + errors.string();
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

std::int64_t count(const std::filesystem::path& database, const std::string& of) {
  Connection connection(database, Connection::Mode::read);
  Statement row = connection.prepare("SELECT count(*) FROM " + of);
  row.step();
  return row.integer(0);
}

/// Kills the process in the midst of an evaluation, once so many are stored. False where it ended
/// by itself.
bool kill_at(pid_t child,
             std::int64_t begun,
             std::int64_t stored,
             const std::filesystem::path& database) {
  const std::string running =
      "attempt WHERE state = 'running' AND started_at >= " + std::to_string(begun);
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (count(database, "evaluation") < stored || count(database, running) == 0) continue;
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    return WIFSIGNALED(status);
  }
  return false;
}

}  // namespace

TEST_CASE("a calibration that is interrupted says how it goes on and how it is ended",
          "[end_to_end]") {
  const TemporaryFolder folder;
  const auto study = slow_study(folder), database = folder / "a.db", errors = folder / "errors";
  { const Store empty(database, Access::write); }
  const pid_t child = start(study, database, folder / "answer.json", errors);
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (count(database, "evaluation") == 0) continue;
    kill(child, SIGINT);
    waitpid(child, &status, 0);
    break;
  }
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 130);
  const std::string told = read(errors), same = " --db " + database.string();
  CHECK_THAT(told,
             Catch::Contains("repose calibrate " + study.string() + same +
                             " --workers 2 --no-pictures --json\n"));
  CHECK_THAT(told, Catch::Contains("repose cancel 1" + same + "\n"));
}

TEST_CASE("kill -9 in the midst of evaluations costs none that is stored and no bit of the fit",
          "[end_to_end][slow]") {
  const TemporaryFolder folder;
  const auto study = slow_study(folder);
  int status = 0;
  waitpid(start(study, folder / "whole.db", folder / "whole.json"), &status, 0);
  REQUIRE(status == 0);

  const auto database = folder / "killed.db";
  { const Store empty(database, Access::write); }  // the kills are not to fall into its making
  std::int64_t kills = 0;
  for (const std::int64_t stored : {1, 3, 5, 7, 9}) {
    const std::int64_t begun = microseconds_now();
    kills += kill_at(start(study, database, folder / "killed.json"), begun, stored, database);
  }
  CHECK(kills == 5);
  waitpid(start(study, database, folder / "killed.json"), &status, 0);
  REQUIRE(status == 0);
  CHECK(fit_of(folder / "killed.json") == fit_of(folder / "whole.json"));

  CHECK(count(database, "evaluation") == count(folder / "whole.db", "evaluation"));
  CHECK(count(database, "attempt WHERE state = 'answered'") == count(database, "evaluation"));
  const std::int64_t lost = count(database, "attempt WHERE state = 'lost'");
  CHECK(lost > 0);
  CHECK(lost <= kills * workers);
  CHECK(count(database, "attempt") == count(database, "evaluation") + lost);
}
