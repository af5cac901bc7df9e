// One contract for all executors, whatever happens to those who answer.
#include "server/jobs/executor.hpp"

#include <fstream>
#include <shared_mutex>
#include <thread>
#include <variant>

#include <catch2/catch.hpp>

#include "db/attempt_store.hpp"
#include "engine/evaluate.hpp"
#include "server/json/evaluation_json.hpp"
#include "tests/support/program.hpp"
#include "tests/support/reference_grain.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace repose;
using namespace repose::server;
using repose::tests::repose_program;
using repose::tests::TemporaryFolder;
using End = Attempted::End;
using Ends = std::vector<std::string>;

namespace {

engine::Trial drop(std::uint64_t seed = 1) {
  return {repose::tests::reference_grain(), {"drop", engine::Fidelity::draft, {}}, seed};
}

/// A program that stands in for `repose answer`; $been is a file that tells its second run, and
/// `answer` is the true program.
std::filesystem::path script(const TemporaryFolder& folder, const std::string& body) {
  auto path = folder / "program";
  std::ofstream(path) << "#!/bin/sh\nbeen='" << (folder / "been").string() << "'\nanswer() { '"
                      << repose_program << "' answer; }\n"
                      << body << "\n";
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  return path;
}

constexpr ChildLimits limits{.seconds = 30.0, .silence = 30.0};

/// What a question came to, and what the store was told of it.
struct Told {
  Attempts came_to;
  Ends ends;                  ///< of its attempts, in order
  std::vector<double> waits;  /// s between them
};

Told ask(const Executor& executor, db::Store& store, const std::stop_token& stop = {}) {
  Told told;
  std::shared_mutex host;
  const engine::Trial trial = drop();
  const std::string key = evaluation_key(trial);
  told.came_to = attempt(
      executor,
      store,
      host,
      trial,
      key,
      [&](double seconds, const std::stop_token&) { told.waits.push_back(seconds); },
      stop);
  for (const auto& one : db::AttemptStore(store).of(key)) {
    CHECK(one.number == static_cast<std::int64_t>(told.ends.size()));
    CHECK(one.executor == executor.name);
    CHECK(one.finished_at.has_value());
    told.ends.push_back(one.state);
  }
  return told;
}

/// The same with a store of its own.
Told ask(const Executor& executor, const std::stop_token& stop = {}) {
  const TemporaryFolder folder;
  db::Store store(folder / "a.db", db::Access::write);
  Told told = ask(executor, store, stop);
  const bool answered = told.came_to.end == End::answered;
  CHECK(store.evaluation(evaluation_key(drop())).has_value() == answered);
  return told;
}

/// Every executor there is, each ready for use.
std::vector<Executor> executors() {
  return {inline_executor(), child_executor(repose_program, limits)};
}

}  // namespace

TEST_CASE("every executor gives the same answer, bit for bit, in one attempt", "[server]") {
  std::vector<std::string> answers;
  for (const Executor& executor : executors()) {
    INFO(executor.name);
    const Told told = ask(executor);
    CHECK(told.came_to.end == End::answered);
    CHECK(told.ends == Ends{"answered"});
    answers.push_back(told.came_to.answer);
  }
  for (const auto& answer : answers) CHECK(answer == answers.front());
  CHECK(answers.front() == print_answer(engine::evaluate(drop())));
}

TEST_CASE("every executor takes a failure of the physics for an answer", "[server]") {
  // A height below the floor: the engine says so, and would say so again.
  engine::Trial trial = drop();
  trial.experiment.settings = {{"height", -1.0}};
  for (const Executor& executor : executors()) {
    INFO(executor.name);
    const TemporaryFolder folder;
    db::Store store(folder / "a.db", db::Access::write);
    std::shared_mutex host;
    const Attempts came_to = attempt(executor, store, host, trial, "key", wait_for, {});
    CHECK(came_to.end == End::answered);
    const auto evaluation = parse_answer(trial, came_to.answer);
    REQUIRE(std::holds_alternative<engine::Failure>(evaluation.outcome));
    CHECK(std::get<engine::Failure>(evaluation.outcome).kind == engine::FailureKind::bad_input);
  }
}

TEST_CASE("every executor comes back when it is asked to stop, and is not asked again",
          "[server]") {
  const TemporaryFolder folder;
  std::stop_source source;
  source.request_stop();
  auto all = executors();
  all.push_back(child_executor(script(folder, "exec sleep 1000"), limits));
  for (const Executor& executor : all) {
    INFO(executor.name);
    const Told told = ask(executor, source.get_token());
    CHECK(told.came_to.end == End::cancelled);
    CHECK(told.ends == Ends{"cancelled"});
  }
}

TEST_CASE("whatever befalls a process costs its own evaluation only, and is tried by the table",
          "[server]") {
  struct Case {
    std::string_view name;
    const char* body;
    ChildLimits limits;
    End end;
    std::size_t attempts;
  };
  const std::vector<Case> cases{
      {"segmentation fault", "kill -SEGV $$", limits, End::crashed, 3},
      {"abort", "kill -ABRT $$", limits, End::crashed, 3},
      {"killed from outside", "kill -KILL $$", limits, End::crashed, 3},
      {"exit code", "exit 3", limits, End::crashed, 3},
      {"no memory", "exit 12", limits, End::out_of_memory, 2},
      {"endless output", "exec yes", limits, End::crashed, 3},
      {"endless loop", "while :; do echo; done", {.seconds = 0.2}, End::timed_out, 1},
      {"hung", "exec sleep 1000", {.silence = 0.1}, End::lost, 3},
      {"stopped", "kill -STOP $$", {.silence = 0.1}, End::lost, 3},
      {"deaf and silent",
       "trap '' TERM; exec >&-; exec sleep 1000",
       {.silence = 0.1},
       End::lost,
       3},
      {"half an answer", "answer | head -c 100", limits, End::refused, 3},
      {"no answer", "echo hello", limits, End::refused, 3},
      {"another's key", R"(answer | sed 's/"key":"./"key":"x/')", limits, End::refused, 3},
      {"another attempt", R"(answer | sed 's/"attempt":./"attempt":9/')", limits, End::refused, 3},
      {"another engine", R"(answer | sed 's/"engine_version":"/&old-/')", limits, End::refused, 3},
      {"no outcome", R"(answer | sed 's/"observations"/"x"/')", limits, End::refused, 3},
  };
  for (const Case& one : cases) {
    INFO(one.name);
    const TemporaryFolder folder;
    const Told told = ask(child_executor(script(folder, one.body), one.limits));
    CHECK(told.came_to.end == one.end);
    CHECK_FALSE(told.came_to.account.empty());
    const std::string name(attempt_end_names.at(static_cast<std::size_t>(one.end)));
    CHECK(told.ends == Ends(one.attempts, name));
    const auto waits = waits_after(one.end);
    CHECK(told.waits == std::vector<double>(waits.begin(), waits.end()));
  }
}

TEST_CASE("a program that cannot be started is a crash, not an end of the service", "[server]") {
  const Told told = ask(child_executor("/nonexistent/program", limits));
  CHECK(told.ends == Ends{"crashed", "crashed", "crashed"});
}

TEST_CASE("a process that fails once is asked once more, under the next number", "[server]") {
  const TemporaryFolder folder;
  const auto program = script(folder, "if [ -e $been ]; then answer; exit; fi\n: > $been; exit 1");
  const Told told = ask(child_executor(program, limits));
  CHECK(told.came_to.end == End::answered);
  CHECK(told.ends == Ends{"crashed", "answered"});
}

TEST_CASE("a process gets no more memory than its limit", "[server]") {
  if (!limits_memory) return;
  // The question is there once the limit holds. Then dd asks for its block of 256 MB at once.
  const TemporaryFolder folder;
  const auto greedy = script(folder,
                             "question=$(cat)\n"
                             "dd if=/dev/zero of=/dev/null bs=256M count=1 2>/dev/null || exit 12\n"
                             "echo \"$question\" | answer");
  const std::uint64_t half = std::uint64_t{128} << 20U;
  CHECK(ask(child_executor(greedy, {.bytes = half})).ends ==
        Ends{"out_of_memory", "out_of_memory"});
  CHECK(ask(child_executor(greedy, {.bytes = 8 * half})).ends == Ends{"answered"});
}

TEST_CASE("an attempt after one that was short of memory has the host alone", "[server]") {
  const TemporaryFolder folder;
  db::Store store(folder / "a.db", db::Access::write);
  std::shared_mutex host;
  std::vector<bool> others;  // of each attempt: whether another could have run beside it
  const Executor greedy{"greedy", [&](const Question& question, const std::stop_token& stop) {
                          std::jthread([&] {
                            others.push_back(host.try_lock_shared());
                            if (others.back()) host.unlock_shared();
                          }).join();
                          if (others.size() == 1) return Attempted{End::out_of_memory, {}, {}};
                          return inline_executor().ask(question, stop);
                        }};
  const auto at_once = [](double, const std::stop_token&) {};
  CHECK(attempt(greedy, store, host, drop(), "key", at_once, {}).end == End::answered);
  CHECK(others == std::vector<bool>{true, false});
  CHECK(host.try_lock());
  host.unlock();
}

TEST_CASE("a late answer of an attempt that was given up changes nothing", "[server]") {
  for (const Executor& executor : executors()) {
    INFO(executor.name);
    const TemporaryFolder folder;
    db::Store store(folder / "a.db", db::Access::write);
    // While the first attempt works, it is declared lost, as after a restart.
    int asked = 0;
    const Executor slow{executor.name, [&](const Question& question, const std::stop_token& stop) {
                          Attempted answer = executor.ask(question, stop);
                          if (asked++ == 0) {
                            CHECK(db::AttemptStore(store).lose_all(7) == 1);
                            CHECK_FALSE(store.evaluation(question.key).has_value());
                          }
                          return answer;
                        }};
    const Told told = ask(slow, store);
    CHECK(told.ends == Ends{"lost", "answered"});
    CHECK(told.came_to.end == End::answered);
  }
}

TEST_CASE("two attempts at one question that both answer give one row, and the first stays",
          "[server]") {
  const TemporaryFolder folder;
  db::Store store(folder / "a.db", db::Access::write);
  const Told first = ask(inline_executor(), store);
  CHECK(ask(inline_executor(), store).ends == Ends{"answered", "answered"});
  // An engine that lies about itself: other numbers under the same name.
  const Executor liar{
      "inline", [](const Question& question, const std::stop_token&) {
        engine::Evaluation evaluation = engine::evaluate(question.trial);
        ++evaluation.effort.steps;
        return Attempted{End::answered, print_answer_to(question, print_answer(evaluation)), {}};
      }};
  const Told third = ask(liar, store);
  CHECK(third.ends == Ends{"answered", "answered", "refused"});
  CHECK(third.came_to.answer == first.came_to.answer);
  CHECK(db::AttemptStore(store).totals() ==
        std::map<std::string, std::int64_t>{{"answered", 2}, {"refused", 1}});
}
