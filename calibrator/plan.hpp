/// Plan: how the budget is split before anything is known.
#pragma once

#include "calibrator/calibration.hpp"

namespace repose::calibrator {

struct Plan {
  int start = 0;       ///< space-filling points
  int least = 0;       ///< of these that must succeed
  int replicates = 4;  ///< at the best of them
  int pairs = 0;       ///< of these repeated at the confirming fidelity
  int confirm = 4;     ///< fresh replicates of the recommended point, at the least
  bool affordable = true;

  [[nodiscard]] int total() const { return start + replicates + pairs + confirm; }
};

Plan make_plan(const Calibration& calibration);

/// Evaluations that pay for a plan in which nothing is given up, and for a first batch of search.
int searching_budget(const Calibration& calibration);

}  // namespace repose::calibrator
