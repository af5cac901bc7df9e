#include "server/jobs/workers.hpp"

#include <fstream>

#include <catch2/catch.hpp>

#include "server/json/evaluation_json.hpp"
#include "tests/support/program.hpp"
#include "tests/support/reference_grain.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace repose;
using namespace repose::server;
using repose::tests::repose_program;
using repose::tests::TemporaryFolder;

namespace {

engine::Trial drop(double height, std::uint64_t seed = 1) {
  return {repose::tests::reference_grain(),
          {"drop", engine::Fidelity::draft, {{"height", height}}},
          seed};
}

/// A program that stands in for `repose answer`.
std::filesystem::path script(const TemporaryFolder& folder, const std::string& body) {
  auto path = folder / "program";
  std::ofstream(path) << "#!/bin/sh\n" << body << "\n";
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  return path;
}

/// One worker that does not wait between attempts.
WorkerOptions impatient(const std::filesystem::path& program, double limit) {
  return {.workers = 1,
          .program = program,
          .time_limit = limit,
          .wait = [](double, const std::stop_token&) {}};
}

engine::FailureKind failure(const engine::Evaluation& evaluation) {
  REQUIRE(std::holds_alternative<engine::Failure>(evaluation.outcome));
  return std::get<engine::Failure>(evaluation.outcome).kind;
}

double restitution(const engine::Evaluation& evaluation) {
  REQUIRE(std::holds_alternative<std::vector<engine::Observation>>(evaluation.outcome));
  return std::get<std::vector<engine::Observation>>(evaluation.outcome).at(0).value;
}

}  // namespace

TEST_CASE("a batch comes back in its order, whoever finishes first", "[server]") {
  const TemporaryFolder folder;
  db::Store store(folder / "a.db", db::Access::write);
  Workers workers(store, {.workers = 4});
  std::vector<engine::Trial> trials;
  for (const double height : {2.0, 0.01, 1.0, 0.02, 0.5}) trials.push_back(drop(height));
  const auto evaluations = workers.run(trials, {}, {});
  REQUIRE(evaluations.size() == trials.size());
  for (std::size_t i = 0; i < trials.size(); ++i) CHECK(evaluations[i].trial == trials[i]);
  CHECK(workers.used().size() == 5);
  CHECK(workers.used()[1] == evaluation_key(trials[1]));
  CHECK_FALSE(workers.interrupted());
}

TEST_CASE("equal trials run once, and what the store has is not run again", "[server]") {
  const TemporaryFolder folder;
  db::Store store(folder / "a.db", db::Access::write);
  Workers workers(store, {.workers = 2});
  const std::vector trials{drop(0.1), drop(0.1), drop(0.2)};
  std::vector<bool> stored;
  const auto note = [&stored](std::size_t done, std::size_t all, bool was_stored) {
    stored.push_back(was_stored);
    CHECK(done == stored.size());
    CHECK(all == 2);
  };
  const auto first = workers.run(trials, {}, note);
  CHECK(stored == std::vector<bool>{false, false});
  stored.clear();
  const auto second = workers.run(trials, {}, note);
  CHECK(stored == std::vector<bool>{true, true});
  for (std::size_t i = 0; i < trials.size(); ++i) {
    CHECK(restitution(first[i]) == restitution(second[i]));
  }
}

TEST_CASE("the answer of a process is that of this process, bit for bit", "[server]") {
  const TemporaryFolder folder;
  db::Store one(folder / "one.db", db::Access::write);
  db::Store two(folder / "two.db", db::Access::write);
  const std::vector trials{drop(0.3)};
  const auto here = Workers(one, {.workers = 1}).run(trials, {}, {});
  const auto there = Workers(two, {.workers = 1, .program = repose_program}).run(trials, {}, {});
  CHECK(restitution(here[0]) == restitution(there[0]));
  CHECK(here[0].effort.steps == there[0].effort.steps);
}

TEST_CASE("a process that dies, rambles or hangs costs its own evaluation only", "[server]") {
  const TemporaryFolder folder;
  db::Store store(folder / "a.db", db::Access::write);
  std::vector<engine::Trial> trials;
  const auto run = [&](const std::string& body, double limit) {
    trials = {drop(0.1, 1 + trials.front().seed)};  // each a question of its own
    return failure(
        Workers(store, impatient(script(folder, body), limit)).run(trials, {}, {}).at(0));
  };
  trials = {drop(0.1)};
  CHECK(run("kill -SEGV $$", 10) == engine::FailureKind::crashed);
  CHECK(run("echo hello", 10) == engine::FailureKind::crashed);
  CHECK(run("exit 3", 10) == engine::FailureKind::crashed);
  CHECK(run("cat >/dev/null; while :; do :; done", 0.2) == engine::FailureKind::timed_out);
  CHECK(run("trap '' TERM; exec sleep 1000", 0.2) == engine::FailureKind::timed_out);
  CHECK(run("exec >&-; exec sleep 1000", 0.2) == engine::FailureKind::timed_out);
  CHECK(run("exec yes", 10) == engine::FailureKind::crashed);
  CHECK_FALSE(store.evaluation(evaluation_key(trials[0])).has_value());  // none is an answer
}

TEST_CASE("a trial that crashed or ran past the limit is not asked again, but with another limit",
          "[server]") {
  const TemporaryFolder folder;
  db::Store store(folder / "a.db", db::Access::write);
  const auto asked = folder / "asked";  // a line for every process
  const auto run = [&](std::uint64_t seed, const std::string& body, double limit) {
    const auto program = script(folder, "echo >> " + asked.string() + "; " + body);
    return failure(
        Workers(store, impatient(program, limit)).run(std::vector{drop(0.1, seed)}, {}, {}).at(0));
  };
  const auto processes = [&] { return std::filesystem::file_size(asked); };
  CHECK(run(1, "exit 3", 10) == engine::FailureKind::crashed);
  CHECK(processes() == 3);  // thrice, before it is believed
  CHECK(run(1, "exit 3", 10) == engine::FailureKind::crashed);
  CHECK(processes() == 3);
  CHECK(run(2, "exec sleep 1000", 0.1) == engine::FailureKind::timed_out);
  CHECK(processes() == 4);
  CHECK(run(2, "exec sleep 1000", 0.1) == engine::FailureKind::timed_out);
  CHECK(processes() == 4);
  CHECK(run(2, "exec sleep 1000", 0.2) == engine::FailureKind::timed_out);
  CHECK(processes() == 5);
}

TEST_CASE("what the host fails at ends a batch, and nothing of it is kept", "[server]") {
  const TemporaryFolder folder;
  db::Store store(folder / "a.db", db::Access::write);
  const std::vector trials{drop(0.1)};
  const auto other_engine =
      script(folder, "'" + repose_program + R"(' answer | sed 's/"engine_version":"/&other-/')");
  for (const std::filesystem::path& program :
       {other_engine, std::filesystem::path("/nonexistent/program")}) {
    Workers workers(store, impatient(program, 10));
    CHECK_THROWS_AS(workers.run(trials, {}, {}), HostFailure);
  }
  Workers sound(store, impatient(repose_program, 10));
  CHECK(restitution(sound.run(trials, {}, {}).at(0)) > 0.5);
}

TEST_CASE("time spent is the store's word, so that a replay is told the same", "[server]") {
  const TemporaryFolder folder;
  db::Store store(folder / "a.db", db::Access::write);
  const std::vector first{drop(0.1), drop(0.2)};
  const std::vector second{drop(0.3)};
  Workers made(store, {.workers = 2});
  made.run(first, {}, {});
  const double begun = made.spent().core_seconds;
  made.run(second, {}, {});
  CHECK(begun > 0.0);
  CHECK(made.spent().core_seconds > begun);
  CHECK(made.spent().wall_seconds > 0.0);
  CHECK(made.spent().wall_seconds <= made.spent().core_seconds + 1e-5);  // clocks are read apart
  Workers replayed(store, {.workers = 1});
  replayed.run(first, {}, {});
  replayed.run(second, {}, {});
  CHECK(replayed.spent().core_seconds == made.spent().core_seconds);
  CHECK(replayed.spent().wall_seconds == made.spent().wall_seconds);
}

TEST_CASE("a process that dies once is asked once more", "[server]") {
  const TemporaryFolder folder;
  db::Store store(folder / "a.db", db::Access::write);
  const auto program =
      script(folder,
             "if [ -e " + (folder / "been").string() + " ]; then exec '" + repose_program + "'" +
                 " answer; fi\n: > " + (folder / "been").string() + "\nkill -KILL $$");
  const auto evaluations =
      Workers(store, impatient(program, 10)).run(std::vector{drop(0.1)}, {}, {});
  CHECK(restitution(evaluations[0]) > 0.5);
}

TEST_CASE("a batch that is asked to stop comes back at once, and nothing of it is kept",
          "[server]") {
  const TemporaryFolder folder;
  db::Store store(folder / "a.db", db::Access::write);
  std::stop_source source;
  source.request_stop();
  Workers workers(store, {.workers = 2, .program = script(folder, "exec sleep 1000")});
  const std::vector trials{drop(0.1), drop(0.2), drop(0.3)};
  for (const auto& evaluation : workers.run(trials, source.get_token(), {})) {
    CHECK(failure(evaluation) == engine::FailureKind::cancelled);
  }
  CHECK(workers.interrupted());
  CHECK(workers.used().empty());
}

TEST_CASE("a running process is ended when its batch is asked to stop", "[server]") {
  const TemporaryFolder folder;
  db::Store store(folder / "a.db", db::Access::write);
  std::stop_source source;
  // The first trial ends only once the second one's process runs.
  const std::string runs = (folder / "runs").string();
  const auto program = script(folder,
                              "if grep -q '\"seed\":1[,}]'; then while [ ! -e " + runs +
                                  " ]; do :; done; exit; fi; : > " + runs + "; exec sleep 1000");
  WorkerOptions options = impatient(program, 10);
  options.workers = 2;
  Workers workers(store, options);
  const auto stop_after_first = [&source](std::size_t, std::size_t, bool) {
    source.request_stop();
  };
  const auto evaluations =
      workers.run(std::vector{drop(0.1, 1), drop(0.1, 2)}, source.get_token(), stop_after_first);
  CHECK(failure(evaluations[1]) == engine::FailureKind::cancelled);
}
