/// Numbers as people read them: as many digits as the number carries, with its unit.
#pragma once

#include <string>
#include <vector>

#include "engine/unit.hpp"

namespace repose::server {

/// So many digits after the point.
std::string fixed_text(double value, int decimals);

/// So many significant digits, without an exponent where people would write none; "-" for NaN.
std::string number_text(double value, int significant = 4);

/// Digits after the point that show two digits of the error; of a value without error, four
/// significant digits.
int decimals_for(double value, double error);

/// "720.7 ± 1.9" in that unit; without an error just the value. `value` and `error` are SI.
std::string with_error(double value, double error, const engine::Unit& unit);

/// " kg/m3", " deg"; nothing for a plain number.
std::string unit_suffix(const engine::Unit& unit);

/// 1.2 h, 3 min 20 s, 12 s.
std::string duration_text(double seconds);

/// 12 345 678 with a space every three digits.
std::string count_text(unsigned long long count);

/// A marked place of an axis.
struct Tick {
  double place;
  std::string text;  ///< all of an axis with the same number of digits after the point
};

/// Round places for an axis: about `wanted` of them within the range.
std::vector<Tick> ticks(double lower, double upper, int wanted);

}  // namespace repose::server
