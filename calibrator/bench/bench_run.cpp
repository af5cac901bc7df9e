#include "calibrator/bench/bench_run.hpp"

#include <algorithm>
#include <cmath>
#include <stop_token>
#include <utility>

#include "calibrator/baselines/baseline.hpp"
#include "calibrator/calibrate.hpp"
#include "calibrator/ledger.hpp"

namespace repose::calibrator::bench {
namespace {

constexpr int watched = 15;  // evaluations after a hit
constexpr int kept = 12;     // of these, in which it must still be one

/// What was recommended while the search went on.
class Recommendations {
 public:
  void add(int evaluations, bool hit, int rounds) { made_.push_back({evaluations, hit, rounds}); }

  /// Notes in the run when it was solved, if it was. Before the search has ended, `settled` is the
  /// number of evaluations made: what comes later may still undo a hit.
  bool solve(BenchRun& run, int settled) const {
    for (const Recommendation& r : made_) {
      if (r.evaluations + watched > settled) return false;
      if (!standing(r.evaluations)) continue;
      int hits = 0;
      for (int later = 1; later <= watched; ++later) {
        hits += standing(r.evaluations + later) ? 1 : 0;
      }
      if (hits < kept) continue;
      run.solved_at = std::max(r.evaluations, 1);  // 0 says never
      run.rounds_to_solve = r.rounds;
      return true;
    }
    return false;
  }

  bool solve(BenchRun& run) const {
    return !made_.empty() && solve(run, made_.back().evaluations + watched);
  }

 private:
  struct Recommendation {
    int evaluations;
    bool hit;
    int rounds;
  };

  [[nodiscard]] bool standing(int evaluations) const {
    bool hit = false;
    for (const Recommendation& r : made_) {
      if (r.evaluations <= evaluations) hit = r.hit;
    }
    return hit;
  }

  std::vector<Recommendation> made_;
};

BenchRun run_ours(const AnalyticStudy& study, std::span<const KnownRun> known) {
  Recommendations recommendations;
  int rounds = 0;
  BenchRun result;
  const auto observe = [&](const Progress& progress) {
    if (progress.stage == "search") ++rounds;
    if (progress.best.empty()) return;
    recommendations.add(progress.evaluations_done, truly_hits(study, progress.best), rounds);
  };
  result.fit =
      calibrate(study.calibration, evaluator(study), {.observer = observe, .known = known});
  result.truly_hit = truly_hits(study, result.fit.best);
  recommendations.add(result.fit.evaluations, result.truly_hit, rounds);
  recommendations.solve(result);
  return result;
}

BenchRun run_baseline(const AnalyticStudy& study) {
  Recommendations recommendations;
  BenchRun result;
  const Evaluator answers = evaluator(study);
  Ledger ledger(study.calibration, answers);
  std::stop_source stop;
  int rounds = 0;
  BaselineSearch search(ledger, 0, stop.get_token(), [&](const BaselineSearch& now) {
    result.truly_hit = truly_hits(study, ledger.space().at(now.recommended()));
    recommendations.add(ledger.spent(), result.truly_hit, ++rounds);
    if (recommendations.solve(result, ledger.spent())) stop.request_stop();
  });
  search_by_baseline(search, study.calibration.budget.method);
  recommendations.solve(result);
  result.fit.best = ledger.space().at(search.recommended());
  result.fit.evaluations = ledger.spent();
  return result;
}

}  // namespace

BenchRun run(const AnalyticStudy& study, std::span<const KnownRun> known) {
  return study.calibration.budget.method == Method::repose ? run_ours(study, known)
                                                           : run_baseline(study);
}

std::optional<int> quantile(std::span<const BenchRun> runs, double p) {
  std::vector<int> counts;
  for (const BenchRun& run : runs) {
    if (run.solved_at > 0) counts.push_back(run.solved_at);
  }
  std::ranges::sort(counts);
  const auto index =
      static_cast<std::size_t>(std::lround(p * static_cast<double>(runs.size() - 1)));
  if (index >= counts.size()) return std::nullopt;
  return counts[index];
}

double share_solved(std::span<const BenchRun> runs, int within) {
  const auto solved = std::ranges::count_if(
      runs, [within](const BenchRun& run) { return run.solved_at > 0 && run.solved_at <= within; });
  return static_cast<double>(solved) / static_cast<double>(runs.size());
}

AnalyticStudy study_of_case(std::size_t index, Method method, std::uint64_t seed) {
  constexpr std::array<std::size_t, 5> observables{2, 4, 6, 8, 6};
  constexpr int batch = 4;
  const bool wide = observables.at(index) == 8;
  int evaluations = wide ? 100 : 70;
  if (method != Method::repose) evaluations = 400;
  const bool noisy = index + 1 == case_names.size();
  AnalyticStudy study =
      wide ? eight_by_eight(seed, evaluations, batch)
           : granular(observables.at(index), noisy ? 1.5 : 0.5, seed, evaluations, batch);
  study.calibration.budget.method = method;
  return study;
}

}  // namespace repose::calibrator::bench
