#include "engine/effects/moisture_friction.hpp"

#include <catch2/catch.hpp>

#include "engine/amendment.hpp"
#include "tests/engine/verification/table.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;
using namespace repose::tests;

namespace {

constexpr double mu = 0.2, gravity = 9.81;

ParameterSet rising(double rise) {
  ParameterSet set = parameters({.restitution = 0.5, .sliding = mu});
  set.set({"moisture_friction.rise", {MaterialId::grain, MaterialId::wall}}, rise);
  return set;
}

/// What a grain that slides over a floor loses of its speed in a second, m/s2.
double braking(const ParameterSet& set) {
  World world(ContactModel(set), {.time_step = 2e-6, .period = {}});
  world.change_surfaces().push_back(plane(0.0));
  GrainRow grain = sphere(3.248e-3, 1228.0);
  grain.z = grain.radius;
  grain.vx = 2.0;
  world.add(grain);
  for (int i = 0; i < 10000; ++i) world.step();  // at rest upright
  const double fast = world.grains().rows[0].vx, start = world.time();
  for (int i = 0; i < 50000; ++i) world.step();
  return (fast - world.grains().rows[0].vx) / (world.time() - start);
}

}  // namespace

TEST_CASE("a sliding grain brakes with the friction of its moisture", "[engine][verification]") {
  for (const double moisture : {0.06, 0.12, 0.18}) {
    const double expected = gravity * mu * (1.0 + 6.0 * (moisture - 0.12));
    verify("braking of a sliding grain, m/s2",
           expected,
           braking(amended(rising(6.0), {.moisture = moisture})),
           relative(0.01));
  }
}

TEST_CASE("friction falls to none in the dry, not below", "[engine]") {
  const ParameterSet set = amended(rising(15.0), {.moisture = 0.0});
  CHECK(set.get({"sliding_friction.coefficient", {MaterialId::grain, MaterialId::wall}}) == 0.0);
}

TEST_CASE("only the pair that has the effect is amended", "[engine]") {
  const ParameterSet set = amended(rising(6.0), {.moisture = 0.2});
  CHECK(set.get({"sliding_friction.coefficient", {MaterialId::grain, MaterialId::grain}}) == mu);
}
