/// Refusal: why an apparatus cannot work with the grains it is given, said before it runs.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace repose::engine {

/// A length of the apparatus, m, and how many of the largest grains it must measure.
struct LeastLength {
  std::string_view name;
  double length = 0.0;
  double grains = 0.0;
};

/// Which of the lengths are too short for grains of that diameter (m), by how much; empty: none.
std::string too_short(std::initializer_list<LeastLength> lengths, double largest_grain_diameter);

/// Two refusals, either of which may be empty, as one.
std::string both(const std::string& one, const std::string& other);

}  // namespace repose::engine
