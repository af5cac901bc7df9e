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

}  // namespace repose::calibrator
