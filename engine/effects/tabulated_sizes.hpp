/// Tabulated sizes: a sieve curve given by d10, d50 and d90, the diameters below which 10, 50 and
/// 90 % of the mass lie.
///
/// Between them, and on to 0 and 100 %, the share of mass passing is straight over the logarithm of
/// the diameter, as such curves are drawn. With u = ln(d / d50):
///
///   u uniform by mass in [-L, 0] and in [0, H], half of the mass in each,
///   L = -5/4 ln(d10 / d50),   H = 5/4 ln(d90 / d50)
///
/// Grains are drawn by number: a u drawn by mass is kept with probability exp(-3 (u + L)). The mean
/// volume by number is d50^3 (pi / 6) / S, where S is the mean by mass of exp(-3 u):
///
///   S = ((exp(3 L) - 1) / (3 L) + (1 - exp(-3 H)) / (3 H)) / 2
///
/// so a curve's d50 and the material's diameter, that of mean volume, are d50 = diameter S^(1/3).
///
/// Source: ISO 9276-1:1998 (cumulative curve over the logarithm of size).
/// Null:   d10 = d50 = d90: every draw is exactly 1.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct TabulatedSizes {
  struct Parameters {
    double d10_over_d50;
    double d90_over_d50;
  };

  static constexpr EffectText text{
      .name = "tabulated_sizes",
      .title = "Tabulated sizes",
      .summary = "Grains differ in size: a sieve curve through d10, d50 and d90 by mass.",
      .citation = "ISO 9276-1:1998",
      .family = "sizes",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::d10_over_d50,
                        {.name = "d10_over_d50",
                         .unit = unit::one,
                         .meaning = "diameter below which 10 % of the mass lie over the median's",
                         .null_value = 1.0,
                         .lower = 0.5,
                         .upper = 1.0}},
      Field<Parameters>{&Parameters::d90_over_d50,
                        {.name = "d90_over_d50",
                         .unit = unit::one,
                         .meaning = "diameter below which 90 % of the mass lie over the median's",
                         .null_value = 1.0,
                         .lower = 1.0,
                         .upper = 2.0}},
  };
  static constexpr Stage stage = Stage::population;
  static constexpr Scope scope = Scope::material;

  /// Grain volume over mean volume (by number).
  static double populate(const Parameters& p, Random& random) {
    const double low = lower_width(p), high = upper_width(p);
    for (;;) {
      const double share = 2.0 * random.uniform() - 1.0;
      const double u = share < 0.0 ? low * share : high * share;
      if (random.uniform() < std::exp(-3.0 * (u + low))) return std::exp(3.0 * u) * scale(p);
    }
  }

  /// The smallest such ratio.
  static double smallest(const Parameters& p) { return std::exp(-3.0 * lower_width(p)) * scale(p); }
  static double largest(const Parameters& p) { return std::exp(3.0 * upper_width(p)) * scale(p); }

  /// S: volume of the median grain by mass over mean volume by number; exactly 1 at the null.
  static double scale(const Parameters& p) {
    const auto mean_exp = [](double x) { return x == 0.0 ? 1.0 : std::expm1(x) / x; };
    return 0.5 * (mean_exp(3.0 * lower_width(p)) + mean_exp(-3.0 * upper_width(p)));
  }

 private:
  static double lower_width(const Parameters& p) { return -1.25 * std::log(p.d10_over_d50); }
  static double upper_width(const Parameters& p) { return 1.25 * std::log(p.d90_over_d50); }
};

}  // namespace repose::engine::effects
