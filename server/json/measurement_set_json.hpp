/// Sets of measurements <-> documents and tables (CSV, RFC 4180), and the studies that name one.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "db/measurement_store.hpp"
#include "engine/result.hpp"
#include "server/json/page.hpp"
#include "server/json/problem.hpp"

namespace repose::server {

/// A set as it is sent, checked: its measurements are those of a study, on one line.
struct MeasurementSet {
  std::string material;
  std::string measurements;
};

/// {"material", "measurements": [...]}
engine::Result<MeasurementSet, Problems> parse_measurement_set(std::string_view text);

/// A head with the names of members, then one measurement a line. Settings stand in one cell:
/// "height=300 mm; speed=15 rpm".
engine::Result<MeasurementSet, Problems> parse_measurement_table(std::string_view text,
                                                                 const std::string& material);

/// {"name","version","material","created_at","measurements"}
std::string print_measurement_set(const db::MeasurementSetRecord& record);
std::string print_measurement_table(const db::MeasurementSetRecord& record);
/// {"items":[... without measurements],"next"}
Page print_measurement_sets(const std::vector<db::MeasurementSetRecord>& records, int limit);

/// What a submission says beside its study.
struct Submission {
  std::optional<std::string> material;
  std::optional<std::string> set;  ///< name
  std::optional<std::int64_t> version;
  std::string study;  ///< the document without those
};

/// Takes "material" and "measurement_set" out of a study; any other text is handed back as it is.
engine::Result<Submission, Problems> parse_submission(std::string_view text);

/// The study with the measurements of a set.
std::string with_measurements(std::string_view study, std::string_view measurements);

}  // namespace repose::server
