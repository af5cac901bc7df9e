/// What `repose bench laboratory`, `repose bench fidelity` and `repose trends` measured, as JSON.
#pragma once

#include <string>
#include <vector>

#include "server/laboratory/fidelity_pairs.hpp"
#include "server/laboratory/speed.hpp"
#include "server/laboratory/trends.hpp"

namespace repose::server {

std::string print_costs(const std::vector<ExperimentCost>& costs);
std::string print_fidelity_pairs(const std::vector<FidelityPairs>& pairs);
std::string print_trends(const Trends& trends);

}  // namespace repose::server
