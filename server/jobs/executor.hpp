/// Executor: where a question is answered. One contract holds for all of them, and one suite of
/// tests (tests/server/executor_test.cpp): a question in, an answer out, or what became of it.
///
///   question   key (of its content), number of the attempt, trial
///   answer     key, number of the attempt, version of the engine, answer
///
/// An executor neither throws nor tries again, and comes back when it is asked to stop. An answer
/// is accepted where key, number and version are those of the attempt it was asked in, and where
/// that attempt still runs: of one that was given up, or taken for another, nothing is kept.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <shared_mutex>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>

#include "db/store.hpp"
#include "server/jobs/child.hpp"
#include "server/json/attempt_json.hpp"

namespace repose::server {

struct Attempted {
  /// How an attempt ends; `refused` is never an executor's own word.
  enum class End : std::uint8_t {
    answered,
    refused,  ///< with an answer that is none to this question
    crashed,
    out_of_memory,
    timed_out,
    lost,  ///< without a sign of life
    cancelled
  };
  End end = End::answered;
  std::string answer = {};      ///< document, as it came
  std::string account = {};     ///< how it ended, in words
  bool is_of_the_host = false;  ///< no process could be started: that says nothing of the question
};

/// Of the ends, in their order; as the store has them.
inline constexpr std::array<std::string_view, 7> attempt_end_names{
    "answered", "refused", "crashed", "out_of_memory", "timed_out", "lost", "cancelled"};

struct Executor {
  std::string_view name;
  std::function<Attempted(const Question& question, const std::stop_token& stop)> ask;
};

/// In this process: for tests, and where a trial takes less time than a process.
Executor inline_executor();

/// `PROGRAM answer`, a process for each question.
Executor child_executor(std::filesystem::path program, const ChildLimits& limits);

/// The seconds to wait before each further attempt after one that ended so: where the host may be
/// to blame. A time limit that was passed will be passed again.
std::span<const double> waits_after(Attempted::End end);

/// Waits so many seconds, or until a stop.
using Wait = std::function<void(double seconds, const std::stop_token& stop)>;
void wait_for(double seconds, const std::stop_token& stop);

/// What the attempts at a question came to.
struct Attempts {
  Attempted::End end = Attempted::End::answered;  ///< of the last one
  std::string answer = {};                        ///< print_answer()'s, which the store has too
  std::string account = {};                       ///< of an end without an answer
  bool is_of_the_host = false;  ///< nothing was started, or another engine: whatever is asked
};

/// Has a question answered: each attempt is in the store before it begins, and its answer with its
/// end. Where the store has another answer to that question, that one stays, and stands.
/// `host` is shared by the attempts of all questions; one that was short of memory has it alone
/// when it is tried again.
Attempts attempt(const Executor& executor,
                 db::Store& store,
                 std::shared_mutex& host,
                 const engine::Trial& trial,
                 const std::string& key,
                 const Wait& wait,
                 const std::stop_token& stop);

}  // namespace repose::server
