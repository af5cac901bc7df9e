/// Speed of the laboratory: what each virtual experiment takes of one core. A measurement, not a
/// test: machines are shared.
#pragma once

#include <array>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/parameter_set.hpp"

namespace repose::server {

/// At draft and at standard fidelity, in this order.
struct ExperimentCost {
  std::string experiment;
  std::array<double, 2> seconds{};      ///< of the processor, which others disturb less than time
  std::array<double, 2> grain_steps{};  ///< spheres moved by a step; equal on every machine
};

/// Every experiment of the catalogue, one replicate each. Throws std::runtime_error where one fails
/// or is asked to stop.
std::vector<ExperimentCost> laboratory_costs(const engine::ParameterSet& grain,
                                             const std::stop_token& stop);

/// Their sum, named "all".
ExperimentCost sum(const std::vector<ExperimentCost>& costs);

}  // namespace repose::server
