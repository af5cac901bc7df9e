/// Fidelity pairs: what draft readings are worth. Grains spread through the space of plausible ones
/// are put through every experiment at draft and at standard fidelity with one seed.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/experiment.hpp"
#include "server/jobs/workers.hpp"
#include "server/laboratory/draft_bias.hpp"

namespace repose::server {

/// The reference grain with other restitution (0.3 to 0.9), sliding friction (0.2 to 0.8; walls two
/// thirds of it), rolling resistance (0.01 to 0.12) and spread of sizes (0 to 0.3): the Latin
/// hypercube of that many points that leaves the widest gaps.
std::vector<engine::ParameterSet> spread_grains(const engine::ParameterSet& reference,
                                                std::size_t count);

/// One observable of the catalogue over the grains.
struct FidelityPairs {
  std::string experiment;
  engine::ObservableInfo observable;
  std::vector<std::array<double, 2>> readings;  ///< draft and standard, SI; NaN where one failed
  double cost = 0.0;  ///< sphere-steps at draft over those at standard, all grains together

  /// Over the grains that were read at both.
  [[nodiscard]] DraftBias bias() const;
};

using LaboratoryObserver = std::function<void(std::size_t done, std::size_t all, bool stored)>;

/// Every observable of every experiment. Where it is asked to stop, what there is by then.
std::vector<FidelityPairs> fidelity_pairs(const std::vector<engine::ParameterSet>& grains,
                                          Workers& workers,
                                          const std::stop_token& stop,
                                          const LaboratoryObserver& observer);

}  // namespace repose::server
