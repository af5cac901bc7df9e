#include "engine/unit.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace repose::engine {
namespace unit {

std::span<const Unit> all() {
  static constexpr std::array units{
      one,
      percent,
      metre,
      centimetre,
      millimetre,
      micrometre,
      inch,
      second,
      millisecond,
      kilogram,
      gram,
      milligram,
      kilogram_per_second,
      kilogram_per_cubic_metre,
      gram_per_cubic_centimetre,
      kilogram_per_second_metre,
      pascal,
      kilopascal,
      megapascal,
      gigapascal,
      pascal_second,
      joule_per_cubic_metre,
      joule_per_square_metre,
      newton_per_metre,
      metre_per_second,
      millimetre_per_second,
      metre_per_second_squared,
      radian,
      degree,
      radian_per_second,
      degree_per_second,
      revolution_per_minute,
  };
  return units;
}

std::optional<Unit> find(std::string_view symbol) {
  const auto units = all();
  const auto found = std::ranges::find(units, symbol, &Unit::symbol);
  if (found == units.end()) return std::nullopt;
  return *found;
}

}  // namespace unit

std::string short_number(double value, int figures) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(
      text.data(), text.data() + text.size(), value, std::chars_format::general, figures);
  return {text.data(), end.ptr};
}

std::string quantity_text(double value, const Unit& unit) {
  const std::string text = short_number(value / unit.factor, 4);
  return unit.symbol == "1" ? text : text + " " + std::string(unit.symbol);
}

}  // namespace repose::engine
