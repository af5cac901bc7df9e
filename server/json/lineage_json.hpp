/// A lineage <-> document: calibrations that come from one another.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibrator/comparison.hpp"
#include "db/record.hpp"
#include "engine/result.hpp"
#include "server/json/missing_effect_json.hpp"

namespace repose::server {

/// The calibration that a study extends.
std::optional<std::int64_t> parent_of(const std::string& study);

/// One calibration of the store with what came of it.
struct Descent {
  db::CalibrationRecord calibration;
  std::optional<calibrator::Comparison> comparison;  ///< of one that is done
  std::optional<db::DiagnosisRecord> diagnosis;      ///< its last finished one
};

/// {"asked","items":[{"calibration","parent","effect","diagnosis","name","state","created_at",
/// "finished_at","quality","parameters","verdict"}]}
std::string print_lineage(std::int64_t asked, const std::vector<Descent>& descents);

/// One calibration of a lineage.
struct LineageItem {
  std::int64_t calibration = 0;
  std::optional<std::int64_t> parent;
  std::string effect;  ///< that it adds; empty: the base
  std::string name, state;
  std::optional<FitQuality> quality;      ///< of one that is done
  std::optional<std::int64_t> diagnosis;  ///< its last finished one
  std::string verdict, grade;
};

/// Parents before their children; the error is a sentence.
engine::Result<std::vector<LineageItem>, std::string> parse_lineage(std::string_view text);

/// From the base to that calibration and on to its newest finished descendant, finished ones only.
std::vector<LineageItem> path_through(const std::vector<LineageItem>& items,
                                      std::int64_t calibration);

}  // namespace repose::server
