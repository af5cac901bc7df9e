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

std::string enumerate(const std::vector<std::string>& items) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += i + 1 == items.size() ? " and " : ", ";
    text += items[i];
  }
  return text;
}

std::string joined(const std::vector<std::string>& items, std::string_view separator) {
  std::string text;
  for (const std::string& item : items) text.append(text.empty() ? "" : separator).append(item);
  return text;
}

}  // namespace repose::calibrator
