#include "engine/effects/velocity_weakening.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/engine/verification/table.hpp"
#include "tests/support/one_contact.hpp"

using namespace repose::engine;
using namespace repose::tests;

namespace {

constexpr double mu = 0.5;

ParameterSet weak(double ratio, double speed) {
  ParameterSet set = parameters({.restitution = 0.5, .sliding = mu});
  set_pairs(set, "velocity_weakening.ratio", ratio);
  set_pairs(set, "velocity_weakening.speed", speed);
  return set;
}

/// Distance that a grain which cannot turn slides down a plane in a second, from rest; gravity is
/// tilted instead of the plane.
double slide(double ratio, double slope, double push) {
  const double g = 9.81;
  World world(ContactModel(weak(ratio, 1e-3)),
              {.time_step = 2e-5,
               .period = {},
               .gravity = {g * std::sin(slope), 0.0, -g * std::cos(slope)}});
  world.change_surfaces().push_back(plane(0.0));
  GrainRow grain = sphere(3e-3, 1228.0);
  grain.inverse_inertia = 0.0;
  grain.z = 0.9999 * grain.radius;
  grain.vx = push;
  world.add(grain);
  for (int i = 0; i < 50000; ++i) world.step();
  return world.grains().rows[0].x;
}

/// Angle at which gravity that turns slowly moves it by a hundredth of a millimetre, for which
/// it takes it about 0.03 s.
double starting_angle(double ratio) {
  constexpr double rate = 0.25;
  World world(ContactModel(weak(ratio, 0.05)), {.time_step = 2e-5, .period = {}});
  world.change_surfaces().push_back(plane(0.0));
  GrainRow grain = sphere(3e-3, 1228.0);
  grain.inverse_inertia = 0.0;
  grain.z = 0.999 * grain.radius;
  world.add(grain);
  for (int i = 0; i < 10000; ++i) world.step();
  world.turn_gravity(rate);
  const double from = world.time();
  while (world.grains().rows[0].x < 1e-5 && world.time() < from + 4.0) world.step();
  return rate * (world.time() - from);
}

}  // namespace

TEST_CASE("the grip falls from the static to the kinetic with the slip speed",
          "[engine][verification]") {
  constexpr double ratio = 0.6, middle = 0.02, overlap = 1e-4;
  OneContact contact(weak(ratio, middle), 3e-3, 3e-3);
  for (const double v : {0.0, 0.01, 0.02, 0.2, 2.0}) {
    const ContactBlock& c = contact.push({.overlap = overlap, .slip = v}, 1.0);
    verify("weakened grip over the normal force",
           1.0 - (1.0 - ratio) * v / (v + middle),
           c.grip_force[0] / c.normal_force[0],
           absolute(1e-12));
  }
}

TEST_CASE("a block starts at the static angle and slides at the kinetic",
          "[engine][verification]") {
  const double start = std::atan(mu);
  verify("angle at which a block starts to slide, rad", start, starting_angle(0.6), absolute(0.01));
  // Once it slides far above v_c: a = g (sin - q mu cos).
  const double slope = 0.9 * start;
  const double a = 9.81 * (std::sin(slope) - 0.6 * mu * std::cos(slope));
  verify("distance slid in a second, m", 0.5 + 0.5 * a, slide(0.6, slope, 0.5), relative(0.01));
}

TEST_CASE("with equal coefficients the grip stays, to the last bit", "[engine]") {
  OneContact equal(weak(1.0, 0.02), 3e-3, 3e-3);
  OneContact bare(parameters({.restitution = 0.5, .sliding = mu}), 3e-3, 3e-3);
  const ContactState state{.overlap = 1e-4, .slip = 0.3};
  CHECK(equal.push(state).tangent_x[0] == bare.push(state).tangent_x[0]);
}
