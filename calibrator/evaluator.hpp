/// Evaluator: the only way this folder reaches a simulation.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "engine/experiment.hpp"

namespace repose::calibrator {

/// Evaluates a batch and returns it in the same order. Cached, parallel, noisy, failing: same
/// signature, so wrappers stack.
using Evaluator = std::function<std::vector<engine::Evaluation>(std::span<const engine::Trial>)>;

/// What the evaluations so far have taken.
struct Spent {
  double core_seconds = 0.0;  ///< of computing, all cores together
  double wall_seconds = 0.0;  ///< while at least one was running
};

/// Asks whoever answers for it: this folder has no clock.
using Meter = std::function<Spent()>;

}  // namespace repose::calibrator
