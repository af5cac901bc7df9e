/// Air drag: still air holds grains back as they move through it.
///
///   F = -f (pi / 8) C rho d^2 |v| v,   C = max(24 / Re (1 + 0.15 Re^0.687), 0.44),
///   Re = rho d |v| / mu
///
///   f    share of the drag, 1     d  diameter of the sphere of the grain's volume, m
///   rho  density of the air, kg/m3     mu  its viscosity, Pa s     v  velocity, m/s
///
/// A grain is dragged as if it were alone: no wind, no wake of others, no buoyancy, no torque.
///
/// Source: Schiller & Naumann 1933, Z. Ver. Dtsch. Ing. 77, 318-320 (up to Re = 1000; above, the
///         constant of Newton's range).
/// Null:   f = 0: no grain is asked. Density and viscosity are data: air at 20 degrees C.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct AirDrag {
  struct Parameters {
    double share;
    double density;
    double viscosity;
  };
  using Coefficients = Parameters;

  static constexpr EffectText text{
      .name = "air_drag",
      .title = "Air drag",
      .summary =
          "Air slows falling grains: light or small ones land softer and rebound lower from "
          "a metre's height.",
      .citation = "Schiller & Naumann 1933, Z. Ver. Dtsch. Ing. 77, 318-320",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::share,
                        {.name = "share",
                         .unit = unit::one,
                         .meaning = "drag over that of a sphere alone in still air",
                         .null_value = 0.0,
                         .lower = 0.0,
                         .upper = 2.0}},
      Field<Parameters>{&Parameters::density,
                        {.name = "density",
                         .unit = unit::kilogram_per_cubic_metre,
                         .meaning = "density of the air",
                         .null_value = 1.204,
                         .lower = 0.1,
                         .upper = 10.0}},
      Field<Parameters>{&Parameters::viscosity,
                        {.name = "viscosity",
                         .unit = unit::pascal_second,
                         .meaning = "dynamic viscosity of the air",
                         .null_value = 1.825e-5,
                         .lower = 1e-6,
                         .upper = 1e-3}},
  };
  static constexpr Stage stage = Stage::body;
  static constexpr Scope scope = Scope::global;

  static constexpr Parameters strong(const GrainScale&) { return {1.0, 1.204, 1.825e-5}; }

  /// Force on a grain of that diameter, N.
  static Vec3 body(const Coefficients& p, double diameter, const Vec3& velocity) {
    const double speed = norm(velocity);
    const double reynolds = p.density * diameter * speed / p.viscosity;
    if (reynolds == 0.0) return {};
    const double slow = 24.0 / reynolds * (1.0 + 0.15 * std::pow(reynolds, 0.687));
    const double area = unit::pi / 8.0 * p.density * diameter * diameter;
    return (-p.share * area * std::max(slow, 0.44) * speed) * velocity;
  }
};

}  // namespace repose::engine::effects
