#include "engine/effects/hysteresis.hpp"

#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "tests/engine/verification/impact.hpp"
#include "tests/engine/verification/table.hpp"
#include "tests/support/one_contact.hpp"

using namespace repose::engine;
using namespace repose::tests;

namespace {

double rebound(double stiffening, double speed) {
  ParameterSet set;
  set_pairs(set, "hysteresis.stiffening", stiffening);
  return collide({.law = {}, .effects = set, .normal = speed}).normal / speed;
}

double closed_form(double r) {
  const double q = 1.0 - 1.0 / r;
  return std::sqrt(r * (1.0 - 2.5 * q + 1.5 * std::pow(q, 5.0 / 3.0)));
}

}  // namespace

TEST_CASE("hysteresis gives back its share of energy at every speed", "[engine][verification]") {
  for (const double r : {1.2, 2.0, 5.0}) {
    for (const double speed : {0.1, 1.0, 5.0}) {
      verify("restitution under hysteresis, r " + std::to_string(r).substr(0, 3),
             closed_form(r),
             rebound(r, speed),
             absolute(0.002));
    }
  }
}

TEST_CASE("a contact unloads to the overlap that stays and loads again to where it was",
          "[engine][verification]") {
  ParameterSet set = parameters({});
  set_pairs(set, "hysteresis.stiffening", 2.0);
  OneContact contact(set, 3e-3, 3e-3);
  constexpr double most = 2e-4;
  const double left = most * std::pow(0.5, 2.0 / 3.0);
  CHECK(contact.force({.overlap = most}) == Approx(contact.hertz(most)));
  verify("hysteresis, force above the overlap that stays, N",
         2.0 * contact.hertz(1.9e-4) - contact.hertz(most),
         contact.force({.overlap = 1.9e-4}),
         relative(1e-9));
  CHECK(contact.force({.overlap = left * 1.0001}) > 0.0);
  CHECK(contact.force({.overlap = left * 0.9999}) == 0.0);
  CHECK(contact.force({.overlap = most}) == Approx(contact.hertz(most)));
}

TEST_CASE("with equal stiffnesses the force is Hertz's, to the last bit", "[engine]") {
  const Impact bare{.law = {}, .normal = 1.0};
  CHECK(rebound(1.0, 1.0) == collide(bare).normal);
}
