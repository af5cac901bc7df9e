/// Continuation: a calibration that goes on from what the store knows: from the model that it
/// extends, or from the answer that it continues.
#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

#include "calibrator/calibrate.hpp"
#include "calibrator/recheck.hpp"
#include "db/store.hpp"

namespace repose::server {

/// What a night goes on from.
struct Continuation {
  std::int64_t calibration = 0;       ///< whose best set is in force
  std::vector<std::int64_t> runs_of;  ///< calibrations whose runs are known from the start
};

/// That of a calibration which is a night's; nothing where it is none, or the first.
std::optional<Continuation> continuation_of(const db::Store& store, std::int64_t calibration);

/// A finished calibration as it can be continued; nothing where there is none.
std::optional<calibrator::Published> published(const db::Store& store, std::int64_t calibration);

/// The published answer held against the measurements of a calibration; nothing where it is of
/// another space. Known are the runs on this engine, of the latest 10 (d + 1) parameter sets the
/// latest eight each; d is the number of free parameters.
std::optional<calibrator::Recheck> recheck_published(const db::Store& store,
                                                     const calibrator::Calibration& calibration,
                                                     const Continuation& continuation,
                                                     const calibrator::Evaluator& evaluator);

/// calibrate(), with what is known in place of `options.known`: no search where the answer that it
/// continues still holds.
calibrator::Fit calibrate_from_store(const db::Store& store,
                                     std::int64_t id,
                                     const calibrator::Calibration& calibration,
                                     const calibrator::Evaluator& evaluator,
                                     calibrator::CalibrateOptions options);

}  // namespace repose::server
