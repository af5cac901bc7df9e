/// A lineage's document -> structs, for those who show it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/result.hpp"
#include "server/json/missing_effect_json.hpp"

namespace repose::server {

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
