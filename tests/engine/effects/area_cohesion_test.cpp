#include "engine/effects/area_cohesion.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/engine/verification/table.hpp"
#include "tests/support/one_contact.hpp"

using namespace repose::engine;
using namespace repose::tests;

namespace {

constexpr double density = 5e4;  // J/m3

ParameterSet sticky(double k, double sliding = 0.0) {
  ParameterSet set = parameters({.sliding = sliding});
  set_pairs(set, "area_cohesion.energy_density", k);
  return set;
}

/// Area of the circle in which two spheres cut each other, from the height of the triangle of their
/// centres and a point of it.
double circle(double a, double b, double distance) {
  const double x = (distance * distance + a * a - b * b) / (2.0 * distance);
  return unit::pi * (a * a - x * x);
}

}  // namespace

TEST_CASE("area cohesion takes the energy density times the circle of intersection",
          "[engine][verification]") {
  for (const double rj : {3e-3, 1.5e-3, 0.0}) {
    CAPTURE(rj);
    constexpr double ri = 3e-3;
    OneContact contact(sticky(density), ri, rj);
    for (const double d : {1e-6, 1e-5, 1e-4, 5e-4}) {
      const double area =
          rj > 0.0 ? circle(ri, rj, ri + rj - d) : unit::pi * (ri * ri - (ri - d) * (ri - d));
      verify("area cohesion over Hertz's force less k A, 1",
             1.0,
             contact.force({.overlap = d}) / (contact.hertz(d) - density * area),
             absolute(1e-9));
    }
  }
}

TEST_CASE("the strongest pull of area cohesion is that of the two laws' difference",
          "[engine][verification]") {
  // For small overlaps F = K d^(3/2) - B d has its least value at sqrt(d) = 2 B / (3 K).
  OneContact contact(sticky(1e4), 3e-3, 3e-3);
  const double r = contact.reduced_radius();
  const double k = 4.0 / 3.0 * contact.elastic().modulus * std::sqrt(r);
  const double b = 1e4 * 2.0 * unit::pi * r;
  double least = 0.0;
  for (double d = 1e-8; d < 1e-5; d *= 1.001)
    least = std::min(least, contact.force({.overlap = d}));
  verify("area cohesion, strongest pull, N",
         -4.0 * b * b * b / (27.0 * k * k),
         least,
         relative(0.001));
}

TEST_CASE("under area cohesion friction leans on load plus attraction, no more", "[engine]") {
  OneContact contact(sticky(density, 0.4), 3e-3, 3e-3);
  constexpr double d = 1e-4;
  const ContactBlock& c = contact.push({.overlap = d, .slip = 1.0}, 1.0);
  CHECK(c.grip_force[0] == Approx(contact.hertz(d)).epsilon(1e-9));
  CHECK(c.grip_force[0] > c.normal_force[0]);
  CHECK(std::abs(c.tangent_x[0]) == Approx(0.4 * contact.hertz(d)));
}

TEST_CASE("area cohesion ends with the overlap and vanishes at its null", "[engine]") {
  CHECK(OneContact(sticky(density), 3e-3, 3e-3).force({.overlap = 0.0}) == 0.0);
  OneContact off(sticky(0.0), 3e-3, 0.0);
  OneContact bare(parameters({}), 3e-3, 0.0);
  CHECK(off.force({.overlap = 1e-4}) == bare.force({.overlap = 1e-4}));
}
