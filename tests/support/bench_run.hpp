/// Runs a calibration on a toy study and finds out when it had truly solved it.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "calibrator/calibrate.hpp"
#include "tests/support/toy_study.hpp"

namespace repose::toy {

struct BenchRun {
  calibrator::Fit fit;
  int solved_at = 0;        ///< evaluations when the recommended point was truly a hit; 0: never
  bool truly_hit = false;   ///< the final recommendation
  int rounds_to_solve = 0;  ///< batches of the search until then
};

/// Solved: the recommended point is truly within one standard error of every target, and still is
/// in at least 80 % of the next 15 evaluations (calibration.md 6.3).
inline BenchRun bench(const Study& study) {
  struct Recommendation {
    int evaluations;
    bool hit;
    int rounds;
  };
  std::vector<Recommendation> made;
  int rounds = 0;
  BenchRun run;
  run.fit = calibrator::calibrate(
      study.calibration, evaluator(study), {}, [&](const calibrator::Progress& progress) {
        if (progress.stage == "search") ++rounds;
        if (progress.best.empty()) return;
        made.push_back({progress.evaluations_done, truly_hits(study, progress.best), rounds});
      });
  run.truly_hit = truly_hits(study, run.fit.best);
  made.push_back({run.fit.evaluations, run.truly_hit, rounds});
  const auto standing = [&](int evaluations) {
    bool hit = false;
    for (const Recommendation& r : made) {
      if (r.evaluations <= evaluations) hit = r.hit;
    }
    return hit;
  };
  for (const Recommendation& r : made) {
    if (!standing(r.evaluations)) continue;
    int kept = 0;
    for (int later = 1; later <= 15; ++later) kept += standing(r.evaluations + later) ? 1 : 0;
    if (kept < 12) continue;
    run.solved_at = r.evaluations;
    run.rounds_to_solve = r.rounds;
    break;
  }
  return run;
}

/// The p-quantile of evaluations to solve over the runs; `never` stands for those unsolved.
inline int quantile(const std::vector<BenchRun>& runs, double p, int never = 1000) {
  std::vector<int> counts;
  counts.reserve(runs.size());
  for (const BenchRun& run : runs) counts.push_back(run.solved_at > 0 ? run.solved_at : never);
  std::ranges::sort(counts);
  const auto index = std::lround(p * static_cast<double>(counts.size() - 1));
  return counts[static_cast<std::size_t>(index)];
}

inline double share_solved(const std::vector<BenchRun>& runs, int within) {
  const auto solved = std::ranges::count_if(
      runs, [within](const BenchRun& run) { return run.solved_at > 0 && run.solved_at <= within; });
  return static_cast<double>(solved) / static_cast<double>(runs.size());
}

}  // namespace repose::toy
