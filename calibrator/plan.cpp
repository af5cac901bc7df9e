#include "calibrator/plan.hpp"

#include <algorithm>
#include <limits>

namespace repose::calibrator {

Plan make_plan(const Calibration& calibration) {
  const int d = static_cast<int>(calibration.free.size());
  const Budget& budget = calibration.budget;
  Plan plan;
  plan.least = d == 0 ? 1 : d + 2;
  plan.start = d == 0 ? 1 : std::max({2 * d, budget.batch, plan.least});
  plan.pairs = budget.fidelity == budget.confirm_fidelity ? 0 : plan.replicates;
  // What is given up first when the budget is short: points of the start, then repetitions.
  plan.start = std::max(plan.least, plan.start - std::max(0, plan.total() - budget.evaluations));
  if (plan.total() > budget.evaluations) {
    plan.replicates = plan.confirm = 2;
    plan.pairs = std::min(plan.pairs, 2);
  }
  plan.affordable = plan.total() <= budget.evaluations;
  return plan;
}

int searching_budget(const Calibration& calibration) {
  Calibration ample = calibration;
  ample.budget.evaluations = std::numeric_limits<int>::max();
  return make_plan(ample).total() + std::max(calibration.budget.batch, 1);
}

}  // namespace repose::calibrator
