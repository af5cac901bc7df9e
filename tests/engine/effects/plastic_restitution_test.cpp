#include "engine/effects/plastic_restitution.hpp"

#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "tests/engine/verification/impact.hpp"
#include "tests/engine/verification/table.hpp"
#include "tests/support/one_contact.hpp"

using namespace repose::engine;
using namespace repose::tests;

namespace {

double rebound(double softness, double speed) {
  ParameterSet plastic;
  set_pairs(plastic, "plastic_restitution.softness", softness);
  return collide({.law = {}, .effects = plastic, .normal = speed}).normal / speed;
}

/// Speed at which the reference grain begins to yield on a wall (Thornton 1997).
double yield_speed(double softness) {
  const GrainLaw law;
  const double r = 0.5 * law.diameter, strain = 0.5 * unit::pi / softness;
  const double overlap = r * strain * strain;
  const OneContact contact(parameters(law), r, 0.0);
  return std::sqrt(0.8 * contact.hertz(overlap) * overlap / mass(sphere(r, law.density)));
}

/// Thornton 1997, equation for the restitution above the yield speed; u is that speed over v.
double closed_form(double u) {
  const double inner = u / (u + 2.0 * std::sqrt(1.2 - 0.2 * u * u));
  return std::sqrt(1.2 * std::sqrt(3.0)) * std::sqrt(1.0 - u * u / 6.0) * std::pow(inner, 0.25);
}

}  // namespace

TEST_CASE("a yielding contact rebounds as Thornton's closed form", "[engine][verification]") {
  constexpr double softness = 20.0;
  const double yield = yield_speed(softness);
  REQUIRE(yield < 0.1);
  for (const double speed : {0.1, 0.3, 1.0, 3.0, 5.0}) {
    verify("plastic restitution at " + std::to_string(speed).substr(0, 3) + " m/s",
           closed_form(yield / speed),
           rebound(softness, speed),
           absolute(0.002));
  }
}

TEST_CASE("far above the yield speed restitution falls as the fourth root of the speed",
          "[engine][verification]") {
  const double slope = std::log(rebound(50.0, 0.5) / rebound(50.0, 0.05)) / std::log(10.0);
  verify("plastic restitution, exponent of the speed", -0.25, slope, absolute(0.005));
}

TEST_CASE("below the yield speed, and without softness, a contact is elastic", "[engine]") {
  const Impact bare{.law = {}, .normal = 0.1};
  const double elastic = collide(bare).normal / 0.1;
  CHECK(rebound(0.0, 0.1) == elastic);
  REQUIRE(yield_speed(5.0) > 0.2);
  CHECK(rebound(5.0, 0.1) == elastic);
}

TEST_CASE("a yielded contact loads again on the path of its unloading", "[engine]") {
  ParameterSet set = parameters({});
  set_pairs(set, "plastic_restitution.softness", 20.0);
  OneContact contact(set, 3e-3, 3e-3);
  const double most = contact.force({.overlap = 2e-4});
  CHECK(most < contact.hertz(2e-4));
  const double half = contact.force({.overlap = 1.9e-4});
  CHECK(half < most);
  CHECK(contact.force({.overlap = 1e-4}) == 0.0);
  CHECK(contact.force({.overlap = 1.9e-4}) == half);
  CHECK(contact.force({.overlap = 2e-4}) == most);
}
