/// How many evaluations a method needs on an analytic study, and over many of them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "calibrator/bench/analytic_study.hpp"
#include "calibrator/fit.hpp"
#include "calibrator/ledger.hpp"

namespace repose::calibrator::bench {

struct BenchRun {
  int solved_at = 0;        ///< evaluations when the recommended point was truly a hit; 0: never
  int rounds_to_solve = 0;  ///< batches of the search until then
  bool truly_hit = false;   ///< the final recommendation
  Fit fit;                  ///< empty but for the best set where a baseline searched
};

/// Solved: the recommended point is truly within one standard error of every target, and still is
/// in at least 12 of the next 15 evaluations. By the method that the study's budget names; of a
/// baseline only the search is run, and no longer than it takes to solve. Ours is told the `known`
/// runs.
BenchRun run(const AnalyticStudy& study, std::span<const KnownRun> known = {});

/// The p-quantile of evaluations to solve; nothing where too few runs solved it.
std::optional<int> quantile(std::span<const BenchRun> runs, double p);

/// Share of the runs that solved it within so many evaluations.
double share_solved(std::span<const BenchRun> runs, int within);

/// A: 5 parameters, 2 observables   B: 4 observables   C: 6   D: 8 parameters, 8 observables
/// E: C with three times the scatter
inline constexpr std::array<std::string_view, 5> case_names{"A", "B", "C", "D", "E"};

/// The study of a case, with what may be spent: 70 evaluations, four at a time (100 for D); 400 for
/// a baseline.
AnalyticStudy study_of_case(std::size_t index, Method method, std::uint64_t seed);

}  // namespace repose::calibrator::bench
