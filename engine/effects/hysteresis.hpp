/// Hysteresis: a contact that has been pressed together comes apart on a stiffer path.
///
///   F = max(0, H - (r - 1) (H_m - H))
///
///   H    Hertz's force at the overlap, N     H_m  the largest H so far (history), N
///   r    stiffness of unloading over that of loading, 1
///
/// In overlaps this is r K (d^(3/2) - d_p^(3/2)), d_p^(3/2) = (1 - 1/r) d_m^(3/2): the force ends
/// at the overlap d_p that stays. Loading again follows the same path up to H_m. Alone, it gives
/// back
///
///   e^2 = r (1 - (5/2) q + (3/2) q^(5/3)),   q = 1 - 1/r,
///
/// at every speed. The overlap that stays is forgotten when the grains part.
///
/// Source: Walton & Braun 1986, J. Rheol. 30, 949-980 (two stiffnesses, largest overlap); Thakur,
///         Morrissey, Sun, Chen & Ooi 2014, Granular Matter 16, 383-400 (with the power 3/2; here
///         without its adhesion).
/// Null:   r = 1: nothing is taken from Hertz's force.
#pragma once

#include <array>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct Hysteresis {
  struct Parameters {
    double stiffening;
  };
  using Coefficients = Parameters;

  static constexpr EffectText text{
      .name = "hysteresis",
      .title = "Hysteresis",
      .summary =
          "Contacts unload on a stiffer path than they load: compressed beds spring back "
          "less and keep a strain.",
      .citation = "Walton & Braun 1986, J. Rheol. 30, 949-980",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::stiffening,
                        {.name = "stiffening",
                         .unit = unit::one,
                         .meaning = "stiffness of a contact in unloading over that in loading",
                         .null_value = 1.0,
                         .lower = 1.0,
                         .upper = 5.0}},
  };
  static constexpr Stage stage = Stage::dissipation;
  static constexpr Scope scope = Scope::pair;

  static constexpr Parameters strong(const GrainScale&) { return {2.0}; }

  static constexpr int history_columns = 1;

  static Coefficients prepare(const Parameters& p, const PairElastic&) { return p; }

  static void contact(ContactBlock& c, const Coefficients& p, HistoryBlock history, double) {
    const double steeper = p.stiffening - 1.0;
    double* __restrict const largest = history.column(0);
    for (int i = 0; i < ContactBlock::width; ++i) {
      const double hertz = c.elastic_force[i];
      const double most = largest[i] > hertz ? largest[i] : hertz;
      const double force = hertz - steeper * (most - hertz);
      const double now = force > 0.0 ? force : 0.0;
      c.elastic_force[i] = now;
      c.normal_force[i] = now;
      c.grip_force[i] = now;
      largest[i] = most;
    }
  }
};

}  // namespace repose::engine::effects
