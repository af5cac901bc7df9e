/// Conclusion: what a night has come to, once its calibration has ended.
#pragma once

#include <optional>
#include <stop_token>

#include "db/schedule_store.hpp"
#include "server/jobs/workers.hpp"

namespace repose::server {

/// Outcome, promotion, drift, and a diagnosis where no fit is left. Simulates nothing but that:
/// what the night has run is in the store. Nothing where a stop cut the diagnosis off.
std::optional<db::NightEnd> conclude(db::Store& store,
                                     const WorkerOptions& options,
                                     const db::NightRecord& night,
                                     const std::stop_token& stop);

}  // namespace repose::server
