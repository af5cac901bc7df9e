/// Comparisons' documents -> structs, for those who show them; diagnoses of the store <-> documents.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "db/record.hpp"
#include "engine/result.hpp"
#include "server/json/text.hpp"

namespace repose::server {

/// {"id","calibration","state","created_at","finished_at","request","progress","error","result"}
std::string print_diagnosis_record(const db::DiagnosisRecord& record);
/// {"items":[... with the verdict, its grade and text in place of the result]}
std::string print_diagnosis_records(const std::vector<db::DiagnosisRecord>& records);

/// What the service keeps of a diagnosis.
struct DiagnosisRecordDocument {
  std::int64_t id = 0;
  std::int64_t calibration = 0;
  std::string state;
  std::string error;
  std::string result;  ///< document; empty where there is none
};
engine::Result<DiagnosisRecordDocument, std::string> parse_diagnosis_record(std::string_view text);

/// In the unit of the measurement's author.
struct ComparisonRow {
  std::size_t measurement = 0;
  double measured = 0.0, predicted = 0.0, difference = 0.0;
  double lab = 0.0, tolerance = 0.0, runs = 0.0;  ///< shares of the uncertainty
  double z = 0.0, z_before = 0.0;
};

struct FitQuality {
  double misfit = 0.0, freedom = 0.0, p = 1.0, fitted_z = 0.0, held_out_z = 0.0;
};
FitQuality read_quality(const Json& json);

struct ComparisonDocument {
  std::vector<ComparisonRow> rows;
  FitQuality own;
  std::optional<FitQuality> before;
  std::vector<std::string> sentences;
  std::vector<std::string> trends;  ///< in words
};
engine::Result<ComparisonDocument, std::string> parse_comparison(std::string_view text);

}  // namespace repose::server
