#include "calibrator/diagnosis/trace.hpp"

#include <algorithm>
#include <cmath>

namespace repose::calibrator {

using Eigen::Index;
using Vector = Eigen::VectorXd;

bool observed(const SuiteRuns& runs,
              std::size_t suspect,
              const std::vector<Index>& fitted,
              const SuiteRun& run) {
  return run.strengths.contains(suspect) && std::ranges::all_of(fitted, [&](Index index) {
           const auto j = static_cast<std::size_t>(index);
           return std::isfinite(run.values[j]) || !runs.touches(suspect, j);
         });
}

Trace trace_of(const SuiteRuns& runs,
               std::size_t suspect,
               const std::vector<Index>& fitted,
               const Model& base,
               const Vector& at) {
  const Vector before = base.emulator.mean(at)(fitted);
  Vector change = Vector::Zero(before.size());
  double count = 0.0, strength = 0.0;
  for (const SuiteRun& run : runs.all()) {
    if (!observed(runs, suspect, fitted, run)) continue;
    strength = run.strengths.at(suspect);
    count += 1.0;
    for (Index row = 0; row < change.size(); ++row) {
      const auto j = static_cast<std::size_t>(fitted[static_cast<std::size_t>(row)]);
      if (runs.touches(suspect, j)) change(row) += run.values[j] - before(row);
    }
  }
  Vector variance = base.emulator.noise()(fitted) / count + base.emulator.variance(at)(fitted);
  for (Index row = 0; row < variance.size(); ++row) {
    const auto j = static_cast<std::size_t>(fitted[static_cast<std::size_t>(row)]);
    if (!runs.touches(suspect, j)) variance(row) = 0.0;
  }
  return {change / (count * strength), variance / (strength * strength)};
}

}  // namespace repose::calibrator
