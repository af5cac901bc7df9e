/// One collision of a sphere with a plane or another sphere, without gravity, and what came of it.
#pragma once

#include "tests/support/reference_grain.hpp"

namespace repose::tests {

struct Impact {
  GrainLaw law;                       ///< its diameter is that of the sphere
  engine::ParameterSet effects = {};  ///< parameters besides the law's
  bool wall = true;                   ///< against a plane; else against a sphere
  double normal = 0.0;                ///< speed of approach of the pair, m/s
  double tangential = 0.0;            ///< velocity of the sphere along x, m/s
  double spin = 0.0;                  ///< of the sphere about y, rad/s
  double partner_spin = 0.0;
  double size_ratio = 1.0;     ///< radius of the other sphere over that of the sphere
  double density_ratio = 1.0;  ///< the same for density
  double steps = 400;          ///< in the time an elastic contact lasts
};

struct Rebound {
  double overlap = 0.0;     ///< largest, m
  double force = 0.0;       ///< largest along the normal, N
  double duration = 0.0;    ///< s
  double normal = 0.0;      ///< speed of separation of the pair, m/s
  double tangential = 0.0;  ///< of the sphere along x, m/s
  double spin = 0.0;        ///< of the sphere about y, rad/s
  double slip = 0.0;        ///< of the sphere's surface over its partner's along x, m/s
};

/// The sphere comes from above. A pair of equal spheres meets with opposite velocities, a large
/// partner is at rest.
Rebound collide(const Impact& impact);

/// G of a material with that E and Poisson's ratio, Pa.
constexpr double shear_modulus(double young, double poisson) {
  return young / (2.0 * (1.0 + poisson));
}

}  // namespace repose::tests
