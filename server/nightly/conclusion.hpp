/// Conclusion: what a night has come to, once its calibration has ended.
#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>

#include "db/schedule_store.hpp"
#include "server/jobs/workers.hpp"

namespace repose::server {

/// A night's end, or what it waits for; neither where a stop cut the look off.
struct Conclusion {
  std::optional<db::NightEnd> end = {};
  std::optional<std::int64_t> diagnosis = {};  ///< that is queued or runs
};

/// Outcome, promotion, drift, and a diagnosis where no fit is left: it is queued, and the night ends
/// when it has ended. Simulates nothing: what the night has run is in the store.
Conclusion conclude(db::Store& store,
                    const WorkerOptions& options,
                    const db::NightRecord& night,
                    const std::stop_token& stop);

}  // namespace repose::server
