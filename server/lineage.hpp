/// Lineage: the calibrations that come from one another, each adding an effect to its parent's
/// model.
#pragma once

#include <cstdint>
#include <string>

#include "db/store.hpp"
#include "server/service.hpp"

namespace repose::server {

/// {"asked","items":[{"calibration","parent","effect","diagnosis","name","state",...}]}: the whole
/// tree that the calibration belongs to, each parent before its children.
Answer<std::string> lineage(const db::Store& store, std::int64_t id);

}  // namespace repose::server
