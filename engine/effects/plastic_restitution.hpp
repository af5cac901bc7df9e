/// Plastic restitution: contacts yield at a pressure, and what has yielded does not come back.
///
///   loading    F = Hertz                       up to d_y = R* (pi / 2s)^2
///              F = F_y + pi p R* (d - d_y)     beyond, with p = E* / s
///   unloading  F = F_m (1 - (d_m - d) / h)^(3/2),   h = 3 F_m / (4 E* a_p),
///              a_p^2 = (2 F_m + F_y) / (2 pi p)
///
///   s  reduced modulus E* over the pressure p at which the contact yields, 1
///   d_m, F_m  largest overlap so far (history, m) and the force there, N
///   F_y  Hertz's force at d_y, N     a_p  radius of the patch at the largest overlap, m
///
/// Impacts faster than v_y = sqrt((4/5) F_y d_y / m*) lose energy; far above it e falls as
/// v^(-1/4). With s = 0 the material never yields.
///
/// Source: Thornton 1997, J. Appl. Mech. 64, 383-386.
/// Null:   s = 0: d_y is endless, the force stays Hertz's.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct PlasticRestitution {
  struct Parameters {
    double softness;
  };
  struct Coefficients {
    double reach;     ///< d_y over R*, 1
    double pressure;  ///< p, Pa
  };

  static constexpr EffectText text{
      .name = "plastic_restitution",
      .title = "Plastic restitution",
      .summary =
          "Contacts yield under pressure: hard impacts rebound little, compressed beds keep "
          "part of their strain.",
      .citation = "Thornton 1997, J. Appl. Mech. 64, 383-386",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::softness,
                        {.name = "softness",
                         .unit = unit::one,
                         .meaning = "reduced modulus over the contact pressure at which it yields",
                         .null_value = 0.0,
                         .lower = 0.0,
                         .upper = 50.0}},
  };
  static constexpr Stage stage = Stage::dissipation;
  static constexpr Scope scope = Scope::pair;

  /// Contacts yield in collisions from 0.1 m/s on.
  static Parameters strong(const GrainScale& g) {
    const double r = 0.5 * g.radius, speed = 0.1;
    const double spring = 4.0 / 3.0 * g.elastic.modulus * std::sqrt(r);
    const double yield = std::pow(1.25 * speed * speed * 0.5 * g.mass() / spring, 0.4);
    return {0.5 * unit::pi / std::sqrt(yield / r)};
  }

  static constexpr int history_columns = 1;

  static Coefficients prepare(const Parameters& p, const PairElastic& pair) {
    const double strain = 0.5 * unit::pi / p.softness;
    return {strain * strain, pair.modulus / p.softness};
  }

  static void contact(ContactBlock& c, const Coefficients& k, HistoryBlock history, double) {
    const double reach = k.reach, pressure = k.pressure, stiffness = 4.0 / 3.0 * c.modulus;
    double* __restrict const largest = history.column(0);
    for (int i = 0; i < ContactBlock::width; ++i) {
      const double r = c.radius[i], d = c.overlap[i];
      const double most = largest[i] > d ? largest[i] : d;
      const double yield = reach * r;
      const double yield_force = stiffness * std::sqrt(r * yield) * yield;
      const double force = yield_force + unit::pi * pressure * r * (most - yield);
      const double patch = std::sqrt((2.0 * force + yield_force) / (2.0 * unit::pi * pressure));
      const double left = 1.0 - (most - d) * stiffness * patch / force;
      const double held = left > 0.0 ? left : 0.0;
      const double plastic = force * held * std::sqrt(held);
      const double now = most > yield ? plastic : c.elastic_force[i];
      c.elastic_force[i] = now;
      c.normal_force[i] = now;
      c.grip_force[i] = now;
      largest[i] = most;
    }
  }
};

}  // namespace repose::engine::effects
