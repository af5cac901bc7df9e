/// Phrases: numbers and counts as the calibrator's sentences have them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/unit.hpp"

namespace repose::calibrator {

/// So many figures, but never fewer than the digits before the point: "0.0123", "164".
std::string number(double value, int figures);

/// An SI value in a unit: "12.3 kg/m3".
std::string quantity(double value, const engine::Unit& unit, int figures);

/// "1 run", "2 runs".
std::string counted(std::size_t count, std::string_view thing);

/// "a", "a and b", "a, b and c".
std::string enumerate(const std::vector<std::string>& items);

std::string joined(const std::vector<std::string>& items, std::string_view separator);

}  // namespace repose::calibrator
