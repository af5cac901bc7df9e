// The dashpot: what is asked for is got, whatever the speed, partner and step.
#include "engine/effects/restitution.hpp"

#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "tests/engine/verification/impact.hpp"
#include "tests/engine/verification/table.hpp"

using namespace repose::tests;
using repose::engine::effects::damping_number;

TEST_CASE("the restitution asked for is got from a wall and from a grain",
          "[engine][verification]") {
  // The remaining error is the leapfrog's, first order in the step: 0.005 is what peers hold at any
  // step they use; 400 steps to the contact hold 0.002.
  for (const double e : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98, 1.0}) {
    for (const bool wall : {false, true}) {
      const Rebound got = collide({.law = {.restitution = e}, .wall = wall, .normal = 1.0});
      verify(
          wall ? "restitution at a wall" : "restitution of grains", e, got.normal, absolute(0.002));
    }
  }
}

TEST_CASE("the damping number is that of independent integration", "[engine][verification]") {
  // Computed apart from this project for the same law with the cut at zero force.
  const double table[][2] = {{0.1, 2.780},
                             {0.2, 1.635},
                             {0.3, 1.112},
                             {0.4, 0.793},
                             {0.5, 0.571},
                             {0.6, 0.404},
                             {0.7, 0.273},
                             {0.8, 0.166},
                             {0.9, 0.0766},
                             {0.95, 0.0369},
                             {0.98, 0.0144}};
  for (const auto& row : table) {
    verify("damping number for e " + std::to_string(row[0]).substr(0, 4),
           row[1],
           damping_number(row[0]),
           relative(0.003));
  }
  CHECK(damping_number(1.0) == 0.0);
}

TEST_CASE("restitution does not depend on the speed of impact", "[engine][verification]") {
  for (const double speed : {0.01, 0.1, 1.0}) {
    const Rebound got = collide({.law = {.restitution = 0.6}, .normal = speed});
    verify("restitution at speed " + std::to_string(speed).substr(0, 4),
           0.6,
           got.normal / speed,
           absolute(0.002));
  }
}
