/// Random: counter-based streams. A stream is named by (seed, purpose, index), so what one grain
/// draws depends neither on the other grains nor on the order of drawing.
#pragma once

#include <cmath>
#include <cstdint>

namespace repose::engine {

/// What a stream is for; two purposes never share numbers.
enum class Purpose : std::uint64_t {
  grain_size = 1,
  grain_position = 2,
  grain_velocity = 3,
  grain_orientation = 4,
  trial = 16,           ///< the seed of an evaluation
  design = 17,          ///< space-filling points
  proposal = 18,        ///< draws from an emulator
  diagnosis = 19,       ///< the seed of a diagnosis' evaluation, and its designs
  diagnosis_null = 20,  ///< data drawn from a model in which nothing is missing
};

class Random {
 public:
  Random(std::uint64_t seed, Purpose purpose, std::uint64_t index = 0)
      : state_(mix(mix(mix(seed) ^ static_cast<std::uint64_t>(purpose)) ^ index)) {}

  /// 64 random bits (splitmix64: Steele, Lea & Flood 2014, OOPSLA, fig. 17).
  std::uint64_t bits() { return mix(state_ += golden_gamma); }

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11U) * 0x1.0p-53; }
  double uniform(double lower, double upper) { return lower + (upper - lower) * uniform(); }

  /// Standard normal (polar method: Marsaglia & Bray 1964, SIAM Review 6, 260-264).
  double normal() {
    for (;;) {
      const double a = 2.0 * uniform() - 1.0;
      const double b = 2.0 * uniform() - 1.0;
      const double s = a * a + b * b;
      if (s > 0.0 && s < 1.0) return a * std::sqrt(-2.0 * std::log(s) / s);
    }
  }

 private:
  static constexpr std::uint64_t golden_gamma = 0x9e3779b97f4a7c15ULL;

  static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31U);
  }

  std::uint64_t state_;
};

}  // namespace repose::engine
