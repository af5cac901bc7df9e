/// The missing effect: compare a finished calibration with its measurements, diagnose what its
/// model lacks, and make the calibration that adds it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "calibrator/diagnosis/diagnose.hpp"
#include "calibrator/ledger.hpp"
#include "db/store.hpp"
#include "server/jobs/workers.hpp"
#include "server/service.hpp"

namespace repose::server {

/// {"misfit","p","text","measurements","trends","before"}: before is the calibration it extends.
Answer<std::string> compare(const db::Store& store,
                            std::int64_t id,
                            const calibrator::Tolerances& stated);

/// Queues a diagnosis of a calibration, or takes up an unfinished one with the same question; its
/// number.
Answer<std::int64_t> queue_diagnosis(db::Store& store,
                                     std::int64_t calibration,
                                     const calibrator::Tolerances& stated);

/// Runs a diagnosis that is in the state running to its end. False where it was asked to stop
/// before: it is running still, and asked again it takes what it has from the store.
bool run_diagnosis(db::Store& store,
                   const WorkerOptions& options,
                   std::int64_t id,
                   const std::stop_token& stop,
                   const DiagnosisEvents& events);

/// {"id","calibration","state","created_at","finished_at","request","result","error"}
Answer<std::string> diagnosis(const db::Store& store, std::int64_t id);
/// {"items":[...]} of a calibration, newest first.
Answer<std::string> diagnoses(const db::Store& store, std::int64_t calibration);

/// The study that adds an effect to a finished calibration: its parameters are freed from null, and
/// every run of the calibration and of that diagnosis (its last where none is named) is known from
/// the start.
Answer<std::string> extension_study(const db::Store& store,
                                    std::int64_t id,
                                    const std::string& effect,
                                    std::optional<std::int64_t> diagnosis);

/// What earlier runs tell of a calibration: those of the one that it extends and, where it asks for
/// a warm start, all that the store had of this engine before the calibration was made; so a replay
/// inherits the same.
std::vector<calibrator::KnownRun> inherited_runs(const db::Store& store,
                                                 const calibrator::Calibration& calibration,
                                                 std::int64_t made_at);

}  // namespace repose::server
