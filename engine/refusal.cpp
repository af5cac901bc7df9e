#include "engine/refusal.hpp"

#include "engine/unit.hpp"

namespace repose::engine {

std::string both(const std::string& one, const std::string& other) {
  return one.empty() || other.empty() ? one + other : one + "; " + other;
}

std::string too_short(std::initializer_list<LeastLength> lengths, double largest_grain_diameter) {
  std::string problems;
  for (const LeastLength& l : lengths) {
    const double least = l.grains * largest_grain_diameter;
    if (l.length >= least) continue;
    problems = both(problems,
                    std::string(l.name) + " = " + quantity_text(l.length, unit::millimetre) +
                        " must be at least " + quantity_text(least, unit::millimetre) +
                        ", which is " + short_number(l.grains) + " of the largest grains of " +
                        quantity_text(largest_grain_diameter, unit::millimetre));
  }
  return problems;
}

}  // namespace repose::engine
