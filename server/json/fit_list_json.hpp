/// Lists of fits -> documents.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "db/measurement_store.hpp"
#include "server/json/page.hpp"

namespace repose::server {

/// A finished calibration, and what one needs to take its fit or leave it.
struct ListedFit {
  db::FitRecord record;
  std::optional<std::string> quality;  ///< document: print_fit_quality(); nothing where unreadable
  std::vector<std::int64_t> in_force;  ///< schedules that have it in force
};

/// {"items":[{"calibration","name","material","misfit","stop","quality","in_force","parameters",
/// "not_determined","best","remarks","provenance"}],"next"}
Page print_fits(const std::vector<ListedFit>& fits, int limit);

/// {"items":[{"calibration","name","material","misfit","stop","quality","in_force","parameters",
/// "best","finished_at"}]}
std::string print_best_fits(const std::vector<ListedFit>& fits);

}  // namespace repose::server
