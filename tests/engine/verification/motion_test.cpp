// Few grains on planes and on one another against closed forms.
#include <algorithm>
#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "tests/engine/verification/energy_ledger.hpp"
#include "tests/engine/verification/table.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;
using namespace repose::tests;

namespace {

constexpr double g = 9.81;

double bearing(double load, double modulus, double radius) {
  return std::pow(load / (4.0 / 3.0 * modulus * std::sqrt(radius)), 2.0 / 3.0);
}

/// A grain that bears its weight on a plane, tilted by an angle towards +x.
World on_a_plane(const GrainLaw& law, double angle = 0.0) {
  World world(
      ContactModel(parameters(law)),
      {.time_step = 2e-5, .period = {}, .gravity = {g * std::sin(angle), 0, -g * std::cos(angle)}});
  world.change_surfaces().push_back(plane(0.0));
  GrainRow grain = sphere(0.5 * law.diameter, law.density);
  const double load = mass(grain) * g * std::cos(angle);
  grain.z = grain.radius -
            bearing(load, world.model().law(MaterialId::wall).elastic.modulus, grain.radius);
  world.add(grain);
  return world;
}

const GrainRow& after(World& world, double seconds) {
  const long steps = std::lround(seconds / world.time_step());
  for (long i = 0; i < steps; ++i) world.step();
  return world.grains().rows[0];
}

std::string text(double value) { return std::to_string(value).substr(0, 4); }

}  // namespace

TEST_CASE("a sliding sphere slows at mu g, and ends rolling at 5/7 of its speed",
          "[engine][verification]") {
  for (const double mu : {0.2, 0.45, 0.7}) {
    for (const double v0 : {0.5, 1.5}) {
      const double until_rolling = 2 * v0 / (7 * mu * g);
      const std::string name = "slide to roll, mu " + text(mu) + ", v0 " + text(v0);
      World world = on_a_plane({.restitution = 0.6, .sliding = mu});  // damped: its spring calms
      world.row(0).vx = v0;
      const GrainRow half = after(world, 0.5 * until_rolling);
      verify(name + ", speed half way, m/s", v0 * 6 / 7, half.vx, relative(0.003));
      verify(name + ", spin half way, rad/s", v0 * 5 / 14 / half.radius, half.wy, relative(0.01));
      const GrainRow& end = after(world, 1.5 * until_rolling);
      verify(name + ", speed at the end, m/s", v0 * 5 / 7, end.vx, relative(0.003));
      verify(name + ", surface speed at the end, m/s",
             v0 * 5 / 7,
             end.wy * end.radius,
             relative(0.01));
    }
  }
}

TEST_CASE("a rolling sphere slows at 5/7 of the rolling coefficient times g",
          "[engine][verification]") {
  const double v0 = 0.4, t = 0.2;
  for (const double mu : {0.02, 0.05}) {
    for (const int form : {0, 1, 2}) {
      GrainLaw law{.sliding = 0.5};
      (form == 0 ? law.rolling : form == 1 ? law.elastic_rolling : law.own_spin_rolling) = mu;
      World world = on_a_plane(law);
      world.row(0).vx = v0;
      world.row(0).wy = v0 / world.grains().rows[0].radius;
      constexpr const char* names[] = {"relative", "elastic", "own spin"};
      verify(std::string("rolling decay, ") + names[form] + ", mu_r " + text(mu) + ", m/s",
             v0 - 5.0 / 7.0 * mu * g * t,
             after(world, t).vx,
             relative(0.01));
    }
  }
}

TEST_CASE("a sphere on an incline rolls at 5/7 of g (sin - mu_r cos), or rests",
          "[engine][verification]") {
  const double angle = 10 * unit::pi / 180, t = 0.2;
  for (const double mu : {0.0, 0.05, 0.3}) {
    World world = on_a_plane({.restitution = 0.6, .sliding = 0.6, .elastic_rolling = mu}, angle);
    const double speed =
        std::max(0.0, 5.0 / 7.0 * g * (std::sin(angle) - mu * std::cos(angle)) * t);
    verify("incline of 10 deg, mu_r " + text(mu) + ", m/s",
           speed,
           after(world, t).vx,
           absolute(0.02 * speed + 0.001));
  }
}

TEST_CASE("a sphere slips on an incline steeper than 7/2 mu, and only there",
          "[engine][verification]") {
  // Slipping: a = g (sin - mu cos), dw/dt = (5/2) mu g cos / R; else it rolls at 5/7 g sin.
  const double mu = 0.1, t = 0.2;
  for (const double degrees : {15.0, 25.0, 40.0}) {  // the limit is 19.3
    const double angle = degrees * unit::pi / 180;
    const bool slips = std::tan(angle) > 3.5 * mu;
    World world = on_a_plane({.restitution = 0.6, .sliding = mu}, angle);
    const GrainRow& end = after(world, t);
    const double speed =
        g * t * (slips ? std::sin(angle) - mu * std::cos(angle) : 5.0 / 7.0 * std::sin(angle));
    const double spin = slips ? 2.5 * mu * g * std::cos(angle) * t : speed;
    const std::string name = "frictional incline of " + text(degrees) + " deg, ";
    verify(name + "speed, m/s", speed, end.vx, relative(0.005));
    verify(name + "surface speed, m/s", spin, end.wy * end.radius, relative(0.01));
  }
}

TEST_CASE("a small grain at rest on a large one does not creep in a million steps",
          "[engine][verification][slow]") {
  for (const double ratio : {3.0, 10.0}) {
    const GrainLaw law{.restitution = 0.6, .sliding = 0.5, .elastic_rolling = 0.1};
    World world(ContactModel(parameters(law)), {.time_step = 1e-5, .period = {}});
    world.change_surfaces().push_back(plane(0.0));
    GrainRow large = sphere(0.5 * law.diameter, law.density);
    GrainRow small = sphere(large.radius / ratio, law.density);
    large.z = large.radius;
    small.x = 0.05 * large.radius;  // held off the top by friction and by the couple
    small.z = large.z + std::sqrt(std::pow(large.radius + small.radius, 2) - small.x * small.x);
    world.add(large);
    world.add(small);
    const auto place = [&] {
      const Grains& grains = world.grains();
      const std::size_t k = grains.ids[0] == 1 ? 0 : 1;
      return grains.rows[k].centre() - grains.rows[1 - k].centre();
    };
    after(world, 1.0);
    const Vec3 settled = place();
    for (int step = 0; step < 1000000; ++step) world.step();
    REQUIRE(world.contacts() == 2);
    verify("creep of a small grain on one " + text(ratio) + " times as large, of its radius",
           0.0,
           norm(place() - settled) / small.radius,
           absolute(1e-6));
  }
}

TEST_CASE("an elastic stack keeps its energy for a million steps", "[engine][verification][slow]") {
  const GrainLaw law{};
  World world(ContactModel(parameters(law)), {.time_step = 1e-5, .period = {}});
  world.change_surfaces().push_back(plane(0.0));
  GrainRow grain = sphere(0.5 * law.diameter, law.density);
  for (int k = 0; k < 5; ++k) {
    grain.z = grain.radius * (1 + 2 * k);
    world.add(grain);
  }
  const double scale = 5 * mass(grain) * g * grain.radius * 5;  // potential energy of the stack
  EnergyLedger ledger(world);
  double worst = 0.0;
  for (int step = 0; step < 1000000; ++step) {
    ledger.step();
    if (step % 1000 == 999) worst = std::max(worst, std::abs(ledger.account().missing()) / scale);
  }
  verify("energy of an elastic stack, drift of its potential energy", 0.0, worst, absolute(1e-5));
}
