/// Rows of the store -> documents: calibrations, their lists, their evaluations, the service's
/// health.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "db/measurement_store.hpp"
#include "db/record.hpp"
#include "server/json/page.hpp"

namespace repose::server {

/// A calibration with its study and fit, and what it is of where that is known.
std::string print_job(const db::CalibrationRecord& record,
                      const std::optional<std::string>& material,
                      const std::optional<db::MeasurementSetRecord>& set);

Page print_jobs(const std::vector<db::CalibrationRecord>& records, int limit);

Page print_used(const std::vector<db::UsedEvaluation>& used, int limit);

std::string print_health(const std::string& database,
                         const std::map<std::string, std::int64_t>& jobs);

}  // namespace repose::server
