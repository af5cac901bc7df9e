/// JKR adhesion: surfaces that touch hold together by their surface energy, with a neck on parting.
///
///   d = a^2 / R* - sqrt(2 pi w a / E*),   F = 4 E* a^3 / (3 R*) - sqrt(8 pi w E* a^3)
///
///   w  work of adhesion, J/m2 (of equal solids twice the surface energy)     a  patch radius, m
///   d  overlap, m: below zero the surfaces are drawn out into a neck
///
/// Grains catch hold when they touch (d = 0, where F is -8/9 of the pull-off already) and let go at
/// d = -(3/4) (pi^2 w^2 R* / E*^2)^(1/3), where F is -5/9 of it; the pull-off in between is
/// -(3/2) pi w R*. A collision slower than about sqrt(14.2 (w^5 R*^4 / E*^2)^(1/3) / m*) sticks.
/// Friction leans on F + 3 pi w R*, none at a drawn-out neck.
///
/// With s = sqrt(a) and c = sqrt(2 pi w / E*), d gives s^4 - R* c s = R* d: solved by four turns of
/// s <- (R* (d + c s))^(1/4) and eight of Newton.
///
/// Softened grains of the same w keep the pull-off, but lose more in collisions.
///
/// Source: Johnson, Kendall & Roberts 1971, Proc. R. Soc. A 324, 301-313; Thornton & Ning 1998,
///         Powder Technology 99, 154-162 (collisions); Thornton 1991, J. Phys. D 24, 1942-1946
///         (what friction leans on).
/// Null:   w = 0: the law is Hertz's and its difference to him is not taken at all.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct JkrAdhesion {
  struct Parameters {
    double work;
  };
  struct Coefficients {
    double work;   ///< w, J/m2
    double draw;   ///< c = sqrt(2 pi w / E*), sqrt(m)
    double bonds;  ///< sqrt(8 pi w E*), N m^(-3/2)
  };

  static constexpr EffectText text{
      .name = "jkr_adhesion",
      .title = "JKR adhesion",
      .summary =
          "Dry grains stick where they touch: beds pack looser, heaps stand steeper, fine "
          "grains cease to flow.",
      .citation = "Johnson, Kendall & Roberts 1971, Proc. R. Soc. A 324, 301-313",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::work,
                        {.name = "work",
                         .unit = unit::joule_per_square_metre,
                         .meaning = "work needed to separate unit area of two surfaces",
                         .null_value = 0.0,
                         .lower = 0.0,
                         .upper = 5.0}},
  };
  static constexpr Stage stage = Stage::adhesion;
  static constexpr Scope scope = Scope::pair;

  /// The pull-off is twice a grain's weight.
  static Parameters strong(const GrainScale& g) {
    return {2.0 * g.weight() / (1.5 * unit::pi * 0.5 * g.radius)};
  }

  static constexpr int history_columns = 1;  ///< 1 while the surfaces hold, else 0

  static Coefficients prepare(const Parameters& p, const PairElastic& pair) {
    return {p.work,
            std::sqrt(2.0 * unit::pi * p.work / pair.modulus),
            std::sqrt(8.0 * unit::pi * p.work * pair.modulus)};
  }

  /// How far a neck draws out, m.
  static double reach(const Coefficients& k, double reduced_radius) {
    return 0.75 * k.draw * std::cbrt(0.25 * reduced_radius * k.draw);
  }

  static void contact(ContactBlock& c, const Coefficients& k, HistoryBlock history, double) {
    const double draw = k.draw, bonds = k.bonds, stiffness = 4.0 / 3.0 * c.modulus;
    const double lean = 3.0 * unit::pi * k.work;
    double* __restrict const holds = history.column(0);
    for (int i = 0; i < ContactBlock::width; ++i) {
      const double r = c.radius[i], gap = c.gap[i];
      // Let go where (gap / (3/4 c))^3 > R* c / 4.
      const double pull = gap / (0.75 * draw);
      const double kept = pull * pull * pull > 0.25 * r * draw ? 0.0 : holds[i];
      const double hold = c.overlap[i] > 0.0 ? 1.0 : kept;
      const double d = hold > 0.0 ? c.overlap[i] - gap : 0.0;
      const double s = patch_root(r, d, draw);
      const double cube = s * s * s;
      const double force = stiffness / r * cube * cube - bonds * cube;
      const double beyond = hold * (force - stiffness * c.patch_radius[i] * c.overlap[i]);
      const double grip = c.grip_force[i] + beyond + hold * lean * r;
      c.normal_force[i] += beyond;
      c.grip_force[i] = grip > 0.0 ? grip : 0.0;
      holds[i] = hold;
    }
  }

 private:
  /// One turn of Newton on s^4 - R* (d + c s) = 0.
  [[gnu::always_inline]] static inline double newton(double s, double r, double d, double draw) {
    const double cube = s * s * s;
    return s - (cube * s - r * (d + draw * s)) / (4.0 * cube - r * draw);
  }
  /// Square root of the patch radius, from far above (written out: a loop here costs the one
  /// outside its vectors).
  [[gnu::always_inline]] static inline double patch_root(double r, double d, double draw) {
    double s = std::sqrt(std::sqrt(r * (d + draw * 0.3)));
    s = std::sqrt(std::sqrt(r * (d + draw * s)));
    s = std::sqrt(std::sqrt(r * (d + draw * s)));
    s = std::sqrt(std::sqrt(r * (d + draw * s)));
    s = newton(newton(s, r, d, draw), r, d, draw);
    s = newton(newton(s, r, d, draw), r, d, draw);
    s = newton(newton(s, r, d, draw), r, d, draw);
    return newton(newton(s, r, d, draw), r, d, draw);
  }
};

}  // namespace repose::engine::effects
