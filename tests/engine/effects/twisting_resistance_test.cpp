#include "engine/effects/twisting_resistance.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/engine/verification/table.hpp"
#include "tests/support/one_contact.hpp"

using namespace repose::engine;
using namespace repose::tests;

namespace {

ParameterSet twisted(double coefficient) {
  ParameterSet set = parameters({.restitution = 0.5});
  set_pairs(set, "twisting_resistance.coefficient", coefficient);
  return set;
}

}  // namespace

TEST_CASE("a grain that spins on the spot slows at the rate of the capped couple",
          "[engine][verification]") {
  // Weight m g on one point: M = mu m g R, I = (2/5) m R^2, so dw/dt = -(5/2) mu g / R.
  constexpr double mu = 0.05, spin = 40.0, seconds = 0.05;
  constexpr double r = 3e-3;
  World world(ContactModel(twisted(mu)), {.time_step = 1e-5, .period = {}});
  world.change_surfaces().push_back(plane(0.0));
  GrainRow grain = sphere(r, 1228.0);
  const OneContact contact(twisted(mu), r, 0.0);
  const double weight = mass(grain) * 9.81;
  const double stiffness = contact.hertz(1e-6) / std::pow(1e-6, 1.5);
  grain.z = r - std::pow(weight / stiffness, 2.0 / 3.0);
  grain.wz = spin;
  world.add(grain);
  for (int i = 0; i < static_cast<int>(seconds / 1e-5); ++i) world.step();
  // The spring winds up over an angle mu E* / (3 G*) first, with half of the couple on average.
  const double wound = mu * contact.elastic().modulus / (3.0 * contact.elastic().shear_modulus);
  verify("spin after twisting on the spot, rad/s",
         spin - 2.5 * mu * 9.81 / r * (seconds - 0.5 * wound / spin),
         world.grains().rows[0].wz,
         relative(0.002));
}

TEST_CASE("the twisting couple winds up as the patch's spring, to its cap",
          "[engine][verification]") {
  constexpr double mu = 0.1, overlap = 1e-4, spin = 2.0, dt = 1e-5;
  OneContact contact(twisted(mu), 3e-3, 3e-3);
  const double r = contact.reduced_radius();
  const double a = std::sqrt(r * overlap);
  const double stiffness = 4.0 * contact.elastic().shear_modulus * a * a * a;
  double couple = 0.0;
  for (int i = 0; i < 10; ++i)
    couple = contact.push({.overlap = overlap, .twist = spin}, dt).couple_z[0];
  verify("twisting couple over its spring",
         1.0,
         couple / (-stiffness * spin * 10 * dt),
         absolute(1e-9));
  const ContactBlock& c = contact.push({.overlap = overlap, .twist = 1e6}, 1.0);
  verify("twisting couple over its cap",
         1.0,
         c.couple_z[0] / (-mu * r * c.grip_force[0]),
         absolute(1e-9));
}
