#include "server/jobs/executor.hpp"

#include <chrono>
#include <condition_variable>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <system_error>
#include <utility>
#include <variant>

#include "db/attempt_store.hpp"
#include "engine/evaluate.hpp"
#include "server/jobs/clock.hpp"
#include "server/json/evaluation_json.hpp"

namespace repose::server {

using engine::Evaluation;
using engine::Failure;
using engine::FailureKind;
using engine::Trial;
using engine::Unexpected;
using End = Attempted::End;

namespace {

/// Whether a failure is not the engine's but the host's.
bool is_of_the_host(const Evaluation& evaluation) {
  const auto* failure = std::get_if<Failure>(&evaluation.outcome);
  return failure != nullptr &&
         (failure->kind == FailureKind::cancelled || failure->kind == FailureKind::timed_out ||
          failure->kind == FailureKind::crashed);
}

End end_of(const ChildResult& child) {
  switch (child.end) {
    case ChildResult::End::cancelled:
      return End::cancelled;
    case ChildResult::End::timed_out:
      return End::timed_out;
    case ChildResult::End::silent:
      return End::lost;
    case ChildResult::End::died:
      return End::crashed;
    case ChildResult::End::exited:
      break;
  }
  if (child.exit_code == out_of_memory_code) return End::out_of_memory;
  return child.exit_code == 0 ? End::answered : End::crashed;
}

/// Why an answer is none to the question.
struct Refused {
  std::string account;
  bool is_of_the_host = false;
};

/// The evaluation that answers the question, or why the text holds none.
engine::Result<Evaluation, Refused> evaluation_in(const std::string& text,
                                                  const Question& question) {
  const auto answer = parse_attempt_answer(text);
  if (!answer) return Unexpected{Refused{"gave no answer that can be read"}};
  if (answer->key != question.key) return Unexpected{Refused{"answered another question"}};
  if (answer->attempt != question.attempt) {
    return Unexpected{Refused{"answered in the name of another attempt"}};
  }
  if (answer->engine_version != engine::version()) {
    return Unexpected{Refused{"answered with another engine", true}};
  }
  Evaluation evaluation = parse_answer(question.trial, answer->answer);
  if (is_of_the_host(evaluation)) {
    return Unexpected{Refused{"gave an answer that cannot be read"}};
  }
  return evaluation;
}

/// Ends the attempt in the store; what it came to.
Attempts conclude(db::Store& store,
                  const Question& question,
                  const Attempted& attempted,
                  double seconds) {
  db::AttemptStore attempts(store);
  const auto end = [&](End how, const std::string& account, bool is_of_the_host) {
    const std::string_view name = attempt_end_names.at(static_cast<std::size_t>(how));
    const bool ran =
        attempts.end(question.key, question.attempt, name, account, microseconds_now());
    return ran ? Attempts{how, {}, account, is_of_the_host}
               : Attempts{End::lost, {}, "was given up before"};
  };
  if (attempted.end != End::answered) {
    return end(attempted.end, attempted.account, attempted.is_of_the_host);
  }
  const auto evaluation = evaluation_in(attempted.answer, question);
  if (!evaluation) {
    return end(End::refused, evaluation.error().account, evaluation.error().is_of_the_host);
  }
  const std::int64_t now = microseconds_now();
  const auto accepted = attempts.accept(question.attempt,
                                        {.key = question.key,
                                         .question = print_trial(question.trial),
                                         .answer = print_answer(*evaluation),
                                         .seconds = seconds,
                                         .engine_version = std::string(engine::version()),
                                         .created_at = now},
                                        now);
  using Accepted = db::AttemptStore::Accepted;
  if (accepted == Accepted::too_late) return {End::lost, {}, "was given up before"};
  if (accepted == Accepted::other) {
    std::clog << "repose: two answers to " + question.key +
                     " differ: this engine does not give equal bits on every host that answers\n";
  }
  return {End::answered, store.evaluation(question.key)->answer, {}};
}

}  // namespace

Executor inline_executor() {
  return {"inline", [](const Question& question, const std::stop_token& stop) -> Attempted {
            if (stop.stop_requested()) return {End::cancelled, {}, "was asked to stop"};
            const Evaluation evaluation = engine::evaluate(question.trial, {.stop = stop});
            if (is_of_the_host(evaluation)) return {End::cancelled, {}, "was asked to stop"};
            return {End::answered, print_answer_to(question, print_answer(evaluation)), {}};
          }};
}

Executor child_executor(std::filesystem::path program, const ChildLimits& limits) {
  return {"child process",
          [program = std::move(program), limits](const Question& question,
                                                 const std::stop_token& stop) -> Attempted {
            if (stop.stop_requested()) return {End::cancelled, {}, "was asked to stop"};
            try {
              ChildResult child = run_child(program, print_question(question) + "\n", limits, stop);
              return {end_of(child), std::move(child.output), std::move(child.account)};
            } catch (const std::system_error& problem) {
              return {End::crashed, {}, problem.what(), true};
            }
          }};
}

std::span<const double> waits_after(End end) {
  static constexpr std::array twice{1.0, 10.0};
  static constexpr std::array once{10.0};
  switch (end) {
    case End::crashed:
    case End::refused:
    case End::lost:
      return twice;
    case End::out_of_memory:
      return once;
    default:
      return {};
  }
}

void wait_for(double seconds, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock hold(mutex);
  never.wait_for(hold, stop, std::chrono::duration<double>(seconds), [] { return false; });
}

Attempts attempt(const Executor& executor,
                 db::Store& store,
                 std::shared_mutex& host,
                 const Trial& trial,
                 const std::string& key,
                 const Wait& wait,
                 const std::stop_token& stop) {
  const auto ask = [&](auto&& hold) {
    hold.lock();
    const Question question{
        key, db::AttemptStore(store).begin(key, executor.name, microseconds_now()), trial};
    const auto start = std::chrono::steady_clock::now();
    const Attempted attempted = executor.ask(question, stop);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    return conclude(store, question, attempted, took.count());
  };
  std::map<End, std::size_t> ended;
  bool alone = false;
  while (true) {
    Attempts result = alone ? ask(std::unique_lock(host, std::defer_lock))
                            : ask(std::shared_lock(host, std::defer_lock));
    const auto waits = waits_after(result.end);
    const std::size_t before = ended[result.end]++;
    if (before >= waits.size()) return result;
    alone = result.end == End::out_of_memory;
    wait(waits[before], stop);
    if (stop.stop_requested()) return {End::cancelled, {}, "was asked to stop"};
  }
}

}  // namespace repose::server
