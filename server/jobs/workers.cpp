#include "server/jobs/workers.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>
#include <thread>
#include <utility>

#include "engine/evaluate.hpp"
#include "server/jobs/clock.hpp"
#include "server/json/evaluation_json.hpp"

namespace repose::server {

using engine::Evaluation;
using engine::Failure;
using engine::FailureKind;
using engine::Trial;

/// One question of a batch and the places that asked it.
struct Workers::Task {
  const Trial* trial;
  std::string key;
  std::string answer;  ///< document; empty until there is one
  bool stored = false;
  double seconds = 0.0;    ///< it took
  std::int64_t ended = 0;  ///< microseconds since 1970 UTC
};

namespace {

/// A failure of the host, as an answer's document.
std::string host_failure(const Trial& trial, const Attempts& attempts) {
  using End = Attempted::End;
  const FailureKind kind = attempts.end == End::cancelled   ? FailureKind::cancelled
                           : attempts.end == End::timed_out ? FailureKind::timed_out
                                                            : FailureKind::crashed;
  return print_answer({trial, Failure{kind, "the evaluation " + attempts.account, 0.0}, {}});
}

bool is_a(FailureKind kind, const Evaluation& evaluation) {
  const auto* failure = std::get_if<Failure>(&evaluation.outcome);
  return failure != nullptr && failure->kind == kind;
}

std::string crashed_key(const std::string& key) { return key + "/crashed"; }

std::string class_of(const engine::Experiment& experiment) {
  return experiment.name + "/" +
         std::string(engine::fidelity_names[static_cast<std::size_t>(experiment.fidelity)]);
}

}  // namespace

Workers::Workers(db::Store& store, const WorkerOptions& options)
    : store_(store),
      options_(options),
      executor_(options.program.empty() ? inline_executor()
                                        : child_executor(options.program,
                                                         {.seconds = options.time_limit,
                                                          .bytes = options.memory_limit})) {
  if (options_.workers == 0) options_.workers = std::max(1U, std::thread::hardware_concurrency());
}

void Workers::remember(const engine::Experiment& experiment, double seconds) {
  const std::scoped_lock hold(mutex_);
  seconds_[class_of(experiment)] = seconds;
}

/// The order of starting: what took longest last time first, the unknown before the known.
std::vector<std::size_t> Workers::longest_first(const std::vector<Task>& tasks) const {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (!tasks[i].stored) order.push_back(i);
  }
  const auto seconds = [&](std::size_t i) {
    const auto found = seconds_.find(class_of(tasks[i].trial->experiment));
    return found == seconds_.end() ? std::numeric_limits<double>::infinity() : found->second;
  };
  std::ranges::stable_sort(order, std::greater{}, seconds);
  return order;
}

std::string Workers::timed_out_key(const std::string& key) const {
  return key + "/timed_out/" + std::to_string(options_.time_limit);
}

/// What the store has of it: an answer, or what became of an earlier attempt.
void Workers::look_up(Task& task) const {
  for (const std::string& key : {task.key, crashed_key(task.key), timed_out_key(task.key)}) {
    const auto kept = store_.evaluation(key);
    if (!kept) continue;
    task.key = key;
    task.answer = kept->answer;
    task.stored = true;
    task.seconds = kept->seconds;
    task.ended = kept->created_at;
    return;
  }
}

/// Wall time is that during which any of a batch's trials ran, whatever lay between them.
void Workers::count(const std::vector<Task>& tasks) {
  std::vector<std::pair<double, double>> runs;  // begin and end, s
  for (const Task& task : tasks) {
    const double end = 1e-6 * static_cast<double>(task.ended);
    runs.emplace_back(end - task.seconds, end);
    spent_.core_seconds += task.seconds;
  }
  std::ranges::sort(runs);
  double until = 0.0;
  for (const auto& [begin, end] : runs) {
    spent_.wall_seconds += std::max(0.0, end - std::max(begin, until));
    until = std::max(until, end);
  }
}

/// Has the trial answered; a failure of the host is kept under a name of its own.
void Workers::work(Task& task, const std::stop_token& stop) {
  const auto start = std::chrono::steady_clock::now();
  const Attempts attempts =
      attempt(executor_, store_, host_, *task.trial, task.key, options_.wait, stop);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  task.seconds = took.count();
  task.ended = microseconds_now();
  remember(task.trial->experiment, took.count());
  using End = Attempted::End;
  if (attempts.end == End::answered) {
    look_up(task);  // with the store's word for what it took
    return;
  }
  if (attempts.is_of_the_host) throw HostFailure("the evaluation " + attempts.account);
  task.answer = host_failure(*task.trial, attempts);
  if (attempts.end == End::cancelled) return;
  task.key = attempts.end == End::timed_out ? timed_out_key(task.key) : crashed_key(task.key);
  store_.add_evaluation({.key = task.key,
                         .question = print_trial(*task.trial),
                         .answer = task.answer,
                         .seconds = task.seconds,
                         .engine_version = std::string(engine::version()),
                         .created_at = task.ended});
}

std::vector<Evaluation> Workers::run(std::span<const Trial> trials,
                                     const std::stop_token& stop,
                                     const TrialObserver& observer) {
  std::map<std::string, std::size_t> place;  // of each question among the tasks
  std::vector<Task> tasks;
  std::vector<std::size_t> task_of;
  for (const Trial& trial : trials) {
    const std::string key = evaluation_key(trial);
    const auto [found, is_new] = place.try_emplace(key, tasks.size());
    task_of.push_back(found->second);
    if (!is_new) continue;
    Task task{&trial, key, {}};
    look_up(task);
    tasks.push_back(std::move(task));
  }
  std::size_t done = 0;
  std::exception_ptr problem;
  const auto tell = [&](bool stored) {
    const std::scoped_lock hold(mutex_);
    ++done;
    if (observer) observer(done, tasks.size(), stored);
  };
  for (const Task& task : tasks) {
    if (task.stored) tell(true);
  }
  const std::vector<std::size_t> order = longest_first(tasks);
  std::atomic<std::size_t> next = 0;
  const auto serve = [&] {
    for (std::size_t n = next++; n < order.size(); n = next++) {
      try {
        work(tasks[order[n]], stop);
        tell(false);
      } catch (...) {
        const std::scoped_lock hold(mutex_);
        if (!problem) problem = std::current_exception();
        next = order.size();
      }
    }
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < std::min<std::size_t>(options_.workers, order.size()); ++t) {
      threads.emplace_back(serve);
    }
  }
  if (problem) std::rethrow_exception(problem);
  count(tasks);

  std::vector<Evaluation> evaluations;
  used_.clear();
  interrupted_ = false;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const Task& task = tasks[task_of[i]];
    evaluations.push_back(parse_answer(trials[i], task.answer));
    const bool cancelled = is_a(FailureKind::cancelled, evaluations.back());
    interrupted_ |= cancelled;
    if (!cancelled) used_.push_back(task.key);
  }
  return evaluations;
}

}  // namespace repose::server
