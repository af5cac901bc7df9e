/// Phrases: numbers and counts as the calibrator's sentences have them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "engine/unit.hpp"

namespace repose::calibrator {

/// So many figures, but never fewer than the digits before the point: "0.0123", "164".
std::string number(double value, int figures);

/// An SI value in a unit: "12.3 kg/m3".
std::string quantity(double value, const engine::Unit& unit, int figures);

/// "1 run", "2 runs".
std::string counted(std::size_t count, std::string_view thing);

}  // namespace repose::calibrator
