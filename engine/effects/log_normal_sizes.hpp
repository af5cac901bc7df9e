/// Log-normal sizes: the logarithms of grain diameters are normally distributed.
///
///   d = d0 exp(s z),   z normal, drawn anew until |z| <= 2
///   V / V_mean = exp(a z) / m,   a = 3 s,   m = mean of exp(a z)
///              = exp(a2 / 2) (Phi(2 - a) + Phi(2 + a) - 1) / (2 Phi(2) - 1)
///
/// By number or by mass is one and the same s, since a weight of d^3 moves a log-normal
/// distribution without widening it (Hatch & Choate 1929); of the cut one only roughly. The cut
/// keeps diameters within exp(+-2 s) of d0, on which the time step and the neighbour search depend.
///
/// Source: Hatch & Choate 1929, J. Franklin Inst. 207, 369-387; exp(s) is the geometric standard
///         deviation.
/// Null:   s = 0: every draw is exactly 1.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct LogNormalSizes {
  struct Parameters {
    double deviation;
  };

  static constexpr EffectText text{
      .name = "log_normal_sizes",
      .title = "Log-normal sizes",
      .summary = "Grains differ in size: the logarithms of their diameters are normal.",
      .citation = "Hatch & Choate 1929, J. Franklin Inst. 207, 369-387",
      .family = "sizes",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::deviation,
                        {.name = "deviation",
                         .unit = unit::one,
                         .meaning = "standard deviation of the natural logarithm of the diameter",
                         .null_value = 0.0,
                         .lower = 0.0,
                         .upper = 0.4}},
  };
  static constexpr Stage stage = Stage::population;
  static constexpr Scope scope = Scope::material;

  static constexpr double cut = 2.0;  ///< standard deviations kept on either side

  /// Grain volume over mean volume.
  static double populate(const Parameters& p, Random& random) {
    double z = random.normal();
    while (std::abs(z) > cut) z = random.normal();
    return std::exp(3.0 * p.deviation * z) / mean(p);
  }

  /// The smallest such ratio.
  static double smallest(const Parameters& p) {
    return std::exp(-3.0 * p.deviation * cut) / mean(p);
  }
  static double largest(const Parameters& p) { return std::exp(3.0 * p.deviation * cut) / mean(p); }

 private:
  /// Mean of exp(a z) under the cut normal distribution; exactly 1 at a = 0.
  static double mean(const Parameters& p) {
    const double a = 3.0 * p.deviation;
    const auto within = [](double x) { return std::erf(x / std::numbers::sqrt2); };
    return std::exp(0.5 * a * a) * (within(cut - a) + within(cut + a)) / (2.0 * within(cut));
  }
};

}  // namespace repose::engine::effects
