#include "calibrator/phrase.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace repose::calibrator {

std::string number(double value, int figures) {
  std::array<char, 32> text{};
  const bool large = std::abs(value) >= std::pow(10.0, figures) && std::abs(value) < 1e15;
  const int length = large ? std::snprintf(text.data(), text.size(), "%.0f", value)
                           : std::snprintf(text.data(), text.size(), "%.*g", figures, value);
  return {text.data(), static_cast<std::size_t>(length)};
}

std::string quantity(double value, const engine::Unit& unit, int figures) {
  std::string text = number(value / unit.factor, figures);
  return unit.symbol == "1" ? text : text + " " + std::string(unit.symbol);
}

std::string counted(std::size_t count, std::string_view thing) {
  return std::to_string(count) + " " + std::string(thing) + (count == 1 ? "" : "s");
}

}  // namespace repose::calibrator
