/// Size spread: grain volumes vary about the mean.
///
///   V = V_mean x,   x normal with mean 1 and standard deviation s, drawn anew until |x - 1| <= 2 s
///
/// The cut is symmetrical, so the mean volume stays; it leaves 0.88 s of the standard deviation and
/// keeps the smallest grain, on which the time step depends, at x = 1 - 2 s. By VOLUME, since the
/// spread of seeds is measured by weighing them.
///
/// Source: Boac et al. 2010, Trans. ASABE 53(4), 1201-1216, standard deviation factor of kernel
///         mass.
/// Null:   s = 0: every draw is exactly 1.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct SizeSpread {
  struct Parameters {
    double deviation;
  };

  static constexpr EffectText text{
      .name = "size_spread",
      .title = "Size spread",
      .summary = "Grains differ in size: their volumes are normally distributed about the mean.",
      .citation = "Boac et al. 2010, Trans. ASABE 53(4), 1201-1216",
      .family = "sizes",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::deviation,
                        {.name = "deviation",
                         .unit = unit::one,
                         .meaning = "standard deviation of grain volume over mean grain volume",
                         .null_value = 0.0,
                         .lower = 0.0,
                         .upper = 0.45}},
  };
  static constexpr Stage stage = Stage::population;
  static constexpr Scope scope = Scope::material;

  static constexpr Parameters strong(const GrainScale&) { return {0.4}; }

  static constexpr double cut = 2.0;  ///< standard deviations kept on either side

  /// Grain volume over mean volume.
  static double populate(const Parameters& p, Random& random) {
    double x = random.normal();
    while (std::abs(x) > cut) x = random.normal();
    return 1.0 + p.deviation * x;
  }

  /// The smallest such ratio.
  static double smallest(const Parameters& p) { return 1.0 - cut * p.deviation; }
  static double largest(const Parameters& p) { return 1.0 + cut * p.deviation; }
};

}  // namespace repose::engine::effects
