/// Workers: turns a store and a number of processes into an Evaluator. Each answer is in the store
/// before anybody sees it; what the store has is not run again.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

#include "calibrator/evaluator.hpp"
#include "db/store.hpp"
#include "engine/experiment.hpp"
#include "server/jobs/executor.hpp"

namespace repose::server {

struct WorkerOptions {
  unsigned workers = 0;                ///< at once; 0: one per core
  std::filesystem::path program = {};  ///< empty: evaluations run on threads of this process
  double time_limit = 3600.0;          ///< s of wall time for one attempt at an evaluation
  /// Bytes that the process of one evaluation may have; 0: any.
  std::uint64_t memory_limit = std::uint64_t{8} << 30U;
  Wait wait = wait_for;  ///< before another attempt
};

/// No evaluation can be had here at present: the programs of the host fail, whatever they are asked.
class HostFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Workers {
 public:
  /// After each trial: done and all of the batch, and whether the store had it. Called by one
  /// thread at a time.
  using TrialObserver = std::function<void(std::size_t done, std::size_t all, bool stored)>;

  Workers(db::Store& store, const WorkerOptions& options);

  /// The evaluations of a batch in its order. Equal trials run once. A trial whose attempts all
  /// crashed, one that ran past the limit or was cancelled is a Failure of that kind. The first two
  /// are kept under a name of their own, so that a replay meets them too; with another limit, a
  /// trial that ran past it is run again, as is one that was cancelled. Throws HostFailure, and
  /// keeps nothing of the trial, where it is the host that fails.
  std::vector<engine::Evaluation> run(std::span<const engine::Trial> trials,
                                      const std::stop_token& stop,
                                      const TrialObserver& observer);

  /// The keys of the last batch's answers that the store has, in order.
  [[nodiscard]] const std::vector<std::string>& used() const { return used_; }
  /// What the answers of all batches took, by the store's word: a replay is told the same.
  [[nodiscard]] calibrator::Spent spent() const { return spent_; }
  /// Whether any trial of the last batch was cancelled.
  [[nodiscard]] bool interrupted() const { return interrupted_; }

 private:
  struct Task;

  void look_up(Task& task) const;
  void count(const std::vector<Task>& tasks);
  std::vector<std::size_t> longest_first(const std::vector<Task>& tasks) const;
  void work(Task& task, const std::stop_token& stop);
  [[nodiscard]] std::string timed_out_key(const std::string& key) const;
  void remember(const engine::Experiment& experiment, double seconds);

  db::Store& store_;
  WorkerOptions options_;
  Executor executor_;
  std::shared_mutex host_;
  mutable std::mutex mutex_;
  std::map<std::string, double> seconds_;  ///< last wall time by experiment and fidelity
  std::vector<std::string> used_;
  calibrator::Spent spent_;
  bool interrupted_ = false;
};

}  // namespace repose::server
