/// Whether an answer is as good as it says: intervals that hold the truth as often as promised, and
/// a misfit that fresh runs repeat.
///
/// The studies are a bench case's with the truth anywhere in the cube (the prior's own claim) and
/// the targets off by a draw of their standard errors, as measurements are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "calibrator/bench/analytic_study.hpp"

namespace repose::calibrator::bench {

struct Honesty {
  int studies = 0;
  int parameters = 0;         ///< of all studies
  double posterior_90 = 0.0;  ///< share of them whose truth lies within 5 to 95 % of the posterior
  double profile_95 = 0.0;    ///< within the profile-likelihood interval
  double misfit_ratio =
      0.0;             ///< mean misfit shown over mean misfit of eight fresh runs, at the best
  int declared = 0;    ///< studies that ended with a hit
  int false_hits = 0;  ///< of these not within one standard error of the targets in truth
};

/// Seeds 1 to `studies` of a case, an index into case_names.
Honesty honesty_of_case(std::size_t index, int studies);

/// What earlier runs are worth: a study that starts from the first `stored` runs of studies with
/// other truths.
struct WarmStart {
  std::vector<int> evaluations;  ///< new ones until solved, per seed; 0 where not solved
};
WarmStart warm_start_of_case(std::size_t index, int seeds, int stored);

}  // namespace repose::calibrator::bench
