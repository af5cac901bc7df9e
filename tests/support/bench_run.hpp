/// The bench, under the name that the tests know it by.
#pragma once

#include "calibrator/bench/bench_run.hpp"
#include "tests/support/toy_study.hpp"

namespace repose::toy {

inline BenchRun bench(const Study& study) { return run(study); }

/// The p-quantile of evaluations to solve over the runs; `never` stands for those unsolved.
inline int quantile(const std::vector<BenchRun>& runs, double p, int never = 1000) {
  return calibrator::bench::quantile(runs, p).value_or(never);
}

}  // namespace repose::toy
