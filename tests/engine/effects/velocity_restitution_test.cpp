#include "engine/effects/velocity_restitution.hpp"

#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "tests/engine/verification/impact.hpp"
#include "tests/engine/verification/table.hpp"
#include "tests/support/one_contact.hpp"

using namespace repose::engine;
using namespace repose::tests;

namespace {

double rebound(double relaxation, double speed, bool wall, double steps = 400) {
  ParameterSet viscous;
  set_pairs(viscous, "velocity_restitution.relaxation", relaxation);
  const Impact impact{.law = {}, .effects = viscous, .wall = wall, .normal = speed, .steps = steps};
  return collide(impact).normal / speed;
}

/// s of the series for the reference grain.
double loss(double relaxation, double speed, bool wall) {
  const GrainLaw law;
  const double r = (wall ? 0.5 : 0.25) * law.diameter;
  const double whole = 1.0 / sphere(0.5 * law.diameter, law.density).inverse_mass;
  const double m = wall ? whole : 0.5 * whole;
  const double k = 4.0 / 3.0 *
                   OneContact(parameters(law), 1.0, wall ? 0.0 : 1.0).elastic().modulus *
                   std::sqrt(r);
  return 1.5 * relaxation * std::pow(k / m, 0.4) * std::pow(speed, 0.2);
}

/// Rebound of x'' = -max(0, x^1.5 + s x^0.5 x') from x' = 1, by midpoints of a fine step.
double integrated(double s) {
  constexpr double dt = 1e-4;
  double x = 0.0, v = 1.0;
  const auto force = [s](double at, double speed) {
    const double root = std::sqrt(at > 0.0 ? at : 0.0);
    return std::max(0.0, root * (at + s * speed));
  };
  while (v > 0.0 || (x > 0.0 && force(x, v) > 0.0)) {
    const double a = force(x, v);
    const double half_x = x + 0.5 * dt * v, half_v = v - 0.5 * dt * a;
    x += dt * half_v;
    v -= dt * force(half_x, half_v);
  }
  return -v;
}

}  // namespace

TEST_CASE("restitution falls with the speed of impact as the viscoelastic law says",
          "[engine][verification]") {
  constexpr double relaxation = 1e-4;
  for (const bool wall : {true, false}) {
    for (const double speed : {0.1, 0.3, 1.0, 3.0, 5.0}) {
      verify("viscoelastic restitution at " + std::to_string(speed).substr(0, 3) + " m/s",
             integrated(loss(relaxation, speed, wall)),
             rebound(relaxation, speed, wall),
             absolute(0.002));
    }
  }
}

TEST_CASE("a slightly viscous collision loses the first terms of the series",
          "[engine][verification]") {
  constexpr double c1 = 1.15344;
  for (const double speed : {0.1, 1.0, 5.0}) {
    const double s = loss(2e-6, speed, true);
    verify("viscoelastic loss over its series at " + std::to_string(speed).substr(0, 3) + " m/s",
           1.0,
           (1.0 - rebound(2e-6, speed, true, 20000)) / (c1 * s - 0.6 * c1 * c1 * s * s),
           absolute(0.01));
  }
}

TEST_CASE("without relaxation a collision is elastic at every speed", "[engine]") {
  for (const double speed : {0.1, 1.0, 5.0}) {
    const Impact bare{.law = {}, .normal = speed};
    CHECK(rebound(0.0, speed, true) == collide(bare).normal / speed);
  }
}
