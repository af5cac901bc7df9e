#include "engine/effects/capillary_bridge.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/engine/verification/table.hpp"
#include "tests/support/one_contact.hpp"

using namespace repose::engine;
using namespace repose::tests;

namespace {

constexpr double tension = 0.073;  // N/m
constexpr double volume = 1e-3;    // of R^3
constexpr double angle = 0.4;      // rad

ParameterSet moist(double g) {
  ParameterSet set = parameters({});
  set_pairs(set, "capillary_bridge.tension", g);
  set_pairs(set, "capillary_bridge.volume", volume);
  set_pairs(set, "capillary_bridge.angle", angle);
  return set;
}

double willett(double r, double gap) {
  const double x = gap * std::sqrt(r / (volume * r * r * r));
  return -2.0 * unit::pi * r * tension * std::cos(angle) / (1.0 + 1.05 * x + 2.5 * x * x);
}

/// Two grains a gap apart along x, at rest, above a floor; weightless.
World two_grains(double gap, double speed) {
  World world(ContactModel(moist(tension)), {.time_step = 1e-6, .period = {}, .gravity = {}});
  GrainRow grain = sphere(3e-3, 1228.0);
  world.add(grain);
  grain.x = 6e-3 + gap;
  grain.vx = speed;
  world.add(grain);
  return world;
}

double distance(const World& world) {
  const auto& rows = world.grains().rows;
  return std::abs(rows[0].x - rows[1].x);
}

}  // namespace

TEST_CASE("a capillary bridge pulls as Willett's fit until it breaks", "[engine][verification]") {
  for (const double radius_j : {3e-3, 1e-3, 0.0}) {
    OneContact contact(moist(tension), 3e-3, radius_j);
    const double r = 2.0 * contact.reduced_radius();
    const double rupture = (1.0 + 0.5 * angle) * std::cbrt(volume) * r;
    CHECK(contact.force({.overlap = -1e-9}) == 0.0);  // dry until touched
    verify("capillary force under contact over the fit",
           1.0,
           (contact.force({.overlap = 1e-6}) - contact.hertz(1e-6)) / willett(r, 0.0),
           absolute(1e-9));
    for (double gap = 0.0; gap < rupture; gap += 0.05 * rupture) {
      verify("capillary force over the fit",
             1.0,
             contact.force({.overlap = -gap}) / willett(r, gap),
             absolute(1e-9));
    }
    CHECK(contact.force({.overlap = -rupture * 1.0001}) == 0.0);
    CHECK(contact.force({.overlap = -0.5 * rupture}) == 0.0);  // broken until touched again
  }
}

TEST_CASE("grains that have touched hold each other across a gap, others do not", "[engine]") {
  World apart = two_grains(1e-5, 0.0);
  for (int i = 0; i < 1000; ++i) apart.step();
  CHECK(distance(apart) == 6e-3 + 1e-5);
  // Parting slowly after touch, they are drawn back; fast, they leave.
  World slow = two_grains(-1e-9, 0.01), fast = two_grains(-1e-9, 1.0);
  double farthest = 0.0;
  for (int i = 0; i < 20000; ++i) {
    slow.step();
    fast.step();
    farthest = std::max(farthest, distance(slow) - 6e-3);
  }
  CHECK(farthest > 1e-6);
  CHECK(farthest < 1e-4);
  CHECK(distance(fast) > 0.02);
}

TEST_CASE("a bridge breaks at its distance and takes its work along", "[engine][verification]") {
  // Speed left after a bridge is drawn out: kinetic energy less the integral of the force.
  constexpr double r = 3e-3;
  const double rupture = (1.0 + 0.5 * angle) * std::cbrt(volume) * r;
  double work = 0.0;
  constexpr int parts = 100000;
  for (int i = 0; i < parts; ++i) work -= willett(r, (i + 0.5) / parts * rupture) * rupture / parts;
  const double m = 0.5 * mass(sphere(r, 1228.0));
  constexpr double speed = 0.3;
  World world = two_grains(-1e-9, speed);
  for (int i = 0; i < 30000; ++i) world.step();
  const auto& rows = world.grains().rows;
  verify("speed of parting after a bridge, m/s",
         std::sqrt(speed * speed - 2.0 * work / m),
         std::abs(rows[0].vx - rows[1].vx),
         relative(0.001));
}

TEST_CASE("a dry run has the bits of one without bridges", "[engine]") {
  const auto run = [](const ParameterSet& set) {
    World world{ContactModel(set), {.time_step = 1e-5, .period = {}}};
    world.change_surfaces().push_back(plane(0.0));
    GrainRow grain = sphere(3e-3, 1228.0);
    for (int k = 0; k < 5; ++k) {
      grain.x = 1e-4 * k;
      grain.z = 4e-3 + 6.5e-3 * k;
      world.add(grain);
    }
    for (int i = 0; i < 20000; ++i) world.step();
    return world.grains().rows[2];
  };
  ParameterSet dry = parameters({.restitution = 0.7, .sliding = 0.4});
  const GrainRow bare = run(dry);
  set_pairs(dry, "capillary_bridge.tension", 0.0);
  const GrainRow null = run(dry);
  CHECK(bare.x == null.x);
  CHECK(bare.vz == null.vz);
}
