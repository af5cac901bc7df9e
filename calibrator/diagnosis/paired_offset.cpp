#include "calibrator/diagnosis/paired_offset.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "calibrator/diagnosis/models.hpp"

namespace repose::calibrator {

using Eigen::Index;

bool wants_offset(const Calibration& calibration) {
  const Budget& budget = calibration.budget;
  return budget.fidelity == engine::Fidelity::draft && budget.confirm_fidelity == budget.fidelity;
}

void add_offset(SuiteRuns& runs, DiagnosisQuestion& question) {
  constexpr int pairs = 3;
  constexpr double prior = 4.0;  // degrees of freedom that the scatter of the search's runs counts
  const UnitPoint best = runs.space().coordinates(question.fit.best);
  const auto differences = runs.run_pairs(best, engine::Fidelity::standard, pairs);
  const Eigen::VectorXd noise = Models(question, runs).noise();
  for (Index j = 0; j < question.offset.size(); ++j) {
    std::vector<double> seen;
    for (const auto& pair : differences) {
      const double difference = pair[static_cast<std::size_t>(j)];
      if (std::isfinite(difference)) seen.push_back(difference);
    }
    if (seen.empty()) continue;
    const auto count = static_cast<double>(seen.size());
    double mean = 0.0, squares = 0.0;
    for (const double difference : seen) mean += difference / count;
    for (const double difference : seen) squares += (difference - mean) * (difference - mean);
    const double scatter =
        (squares + prior * 2.0 * std::max(noise(j), 0.0)) / (count - 1.0 + prior);
    question.offset(j) = mean;
    question.covariance(j, j) += scatter / count;
  }
}

}  // namespace repose::calibrator
