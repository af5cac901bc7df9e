#include "engine/effects/tapping.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/engine/verification/table.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;
using namespace repose::tests;

namespace {

constexpr double gravity = 9.81, frequency = 30.0;

ParameterSet tapped(double acceleration) {
  ParameterSet set = parameters({.shear_modulus = 1e8, .restitution = 0.5});
  set.set({"tapping.acceleration", {}}, acceleration);
  return set;
}

/// The highest that a grain on the floor gets in a few shakes, of its underside, m.
double hop(double acceleration) {
  World world(ContactModel(tapped(acceleration)), {.time_step = 2e-6, .period = {}});
  world.change_surfaces().push_back(plane(0.0));
  GrainRow grain = sphere(3.248e-3, 1228.0);
  grain.z = grain.radius;
  world.add(grain);
  world.start_shaking();
  double highest = 0.0;
  for (int i = 0; i < 100000; ++i) {
    world.step();
    highest = std::max(highest, world.grains().rows[0].z - grain.radius);
  }
  return highest;
}

}  // namespace

TEST_CASE("a grain in flight moves against the apparatus's own motion", "[engine][verification]") {
  // z = -g t^2 / 2 - A t / w + A sin(w t) / w^2, w = 2 pi f.
  constexpr double a = 20.0, w = 2.0 * unit::pi * frequency, t = 0.04;
  World world(ContactModel(tapped(a)), {.time_step = 1e-6, .period = {}});
  world.add(sphere(3.248e-3, 1228.0));
  world.start_shaking();
  for (int i = 0; i < 40000; ++i) world.step();
  verify("way fallen in 0.04 s seen from a shaken vessel, m",
         -0.5 * gravity * t * t - a * t / w + a * std::sin(w * t) / (w * w),
         world.grains().rows[0].z,
         relative(1e-3));
  world.stop_shaking();
  CHECK(world.gravity() == Vec3{0.0, 0.0, -gravity});
}

TEST_CASE("a grain leaves the floor once the shaking exceeds gravity", "[engine]") {
  CHECK(hop(0.9 * gravity) < 1e-6);
  CHECK(hop(2.0 * gravity) > 1e-4);
}

TEST_CASE("nothing shakes before the filling begins", "[engine]") {
  World shaken(ContactModel(tapped(20.0)), {.time_step = 1e-5, .period = {}});
  World still(ContactModel(tapped(0.0)), {.time_step = 1e-5, .period = {}});
  for (World* world : {&shaken, &still}) {
    world->add(sphere(3.248e-3, 1228.0));
    for (int i = 0; i < 1000; ++i) world->step();
  }
  CHECK(shaken.grains().rows[0].z == still.grains().rows[0].z);
}
