#include "engine/refusal.hpp"

#include <array>
#include <charconv>

namespace repose::engine {

namespace {

std::string short_number(double value) {
  constexpr int figures = 4;
  std::array<char, 32> text{};
  const auto end = std::to_chars(
      text.data(), text.data() + text.size(), value, std::chars_format::general, figures);
  return {text.data(), end.ptr};
}

}  // namespace

std::string millimetres(double length) { return short_number(1e3 * length) + " mm"; }

std::string both(const std::string& one, const std::string& other) {
  return one.empty() || other.empty() ? one + other : one + "; " + other;
}

std::string too_short(std::initializer_list<LeastLength> lengths, double largest_grain_diameter) {
  std::string problems;
  for (const LeastLength& l : lengths) {
    const double least = l.grains * largest_grain_diameter;
    if (l.length >= least) continue;
    problems = both(problems,
                    std::string(l.name) + " = " + millimetres(l.length) + " must be at least " +
                        millimetres(least) + ", which is " + short_number(l.grains) +
                        " of the largest grains of " + millimetres(largest_grain_diameter));
  }
  return problems;
}

}  // namespace repose::engine
