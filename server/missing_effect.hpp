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

/// Runs a diagnosis here and now, and keeps it; the answer is its document. The same diagnosis
/// asked again after an interruption takes its runs from the store.
Answer<std::string> diagnose(db::Store& store,
                             const WorkerOptions& options,
                             std::int64_t id,
                             const calibrator::Tolerances& stated,
                             const std::stop_token& stop,
                             const DiagnosisEvents& events);

/// {"id","calibration","state","created_at","finished_at","request","result","error"}
Answer<std::string> diagnosis(const db::Store& store, std::int64_t id);
/// {"items":[...]} of a calibration, newest first.
Answer<std::string> diagnoses(const db::Store& store, std::int64_t calibration);

/// The study that adds an effect to a finished calibration: its parameters are freed from null, and
/// every run of the calibration and of its last diagnosis is known from the start.
Answer<std::string> extension_study(const db::Store& store,
                                    std::int64_t id,
                                    const std::string& effect);

/// What the runs of the calibration that this one extends tell of it.
std::vector<calibrator::KnownRun> inherited_runs(const db::Store& store,
                                                 const calibrator::Calibration& calibration);

}  // namespace repose::server
