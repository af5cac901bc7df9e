#include "tests/engine/verification/oblique.hpp"

#include <cmath>

namespace repose::tests {

namespace {

double within(double value, double limit) {
  return std::abs(value) > limit ? std::copysign(limit, value) : value;
}

}  // namespace

double slip_ratio(const ObliqueImpact& impact, const TangentialLaw& law) {
  // m = R = E* = 1, so that 8 G* = 4 (1 - nu) / (2 - nu); 7/2 is the sphere's surface over its
  // mass.
  constexpr double speed = 1e-3, steps = 1000.0;
  const double shear = law.stiffness * 4.0 * (1.0 - impact.poisson) / (2.0 - impact.poisson);
  const double whole = 2.943275 * std::pow(15.0 / 16.0 * speed * speed, 0.4) / speed;
  const double dt = whole / steps;
  double overlap = 0.0, approach = speed, held = 0.0;
  double slip = impact.slip * impact.sliding * speed;
  const double before = slip;
  while (true) {
    overlap += approach * dt;
    if (overlap <= 0.0) return slip / before;
    const double patch = std::sqrt(overlap), k = shear * patch;
    const double dashpot = impact.damping * std::sqrt(4.0 / 3.0 * patch);
    const double pressed = 4.0 / 3.0 * overlap * patch + dashpot * approach;
    const double normal = pressed > 0.0 ? pressed : 0.0;
    const double limit = impact.sliding * normal;
    // `held` is the spring's displacement, or the force itself.
    const double unit = law.spring == TangentialLaw::Spring::displacement ? k : 1.0;
    held += slip * dt * k / unit;
    held = within(held * unit, limit) / unit;
    const double drag = law.damping * impact.damping * std::sqrt(2.0 / 3.0 * k);
    const double tangent = within(held * unit + drag * slip, limit);
    approach -= normal * dt;
    slip -= 3.5 * tangent * dt;
  }
}

}  // namespace repose::tests
