// Walls that move: as rigid bodies, and with the forces that Newton's laws demand.
#include "engine/wall_motion.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "engine/random.hpp"
#include "engine/world.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;
using repose::tests::GrainLaw;
using repose::tests::parameters;

namespace {

constexpr double radius = 3.248e-3;  // m

Vec3 random_vector(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

/// Grains at random places between two heights, with random motion.
void scatter(World& world, int count, double side, double low, double high, std::uint64_t seed) {
  Random random(seed, Purpose::grain_position);
  for (int k = 0; k < count; ++k) {
    GrainRow grain = sphere(radius, 1228.0);
    grain.x = random.uniform(0.0, side);
    grain.y = random.uniform(0.0, side);
    grain.z = random.uniform(low, high);
    const Vec3 v = random_vector(random, 0.5), w = random_vector(random, 50.0);
    grain.vx = v.x, grain.vy = v.y, grain.vz = v.z;
    grain.wx = w.x, grain.wy = w.y, grain.wz = w.z;
    world.add(grain);
  }
}

Vec3 momentum(const World& world) {
  Vec3 sum;
  for (const GrainRow& g : world.grains().rows) sum += mass(g) * g.velocity();
  return sum;
}

constexpr GrainLaw sticky{
    .restitution = 0.6, .sliding = 0.45, .rolling = 0.0, .elastic_rolling = 0.05};

}  // namespace

TEST_CASE("a wall moves as a rigid body", "[engine]") {
  struct Case {
    const char* name;
    Surface surface;
    Vec3 velocity, spin;
  };
  const Vec3 turn{1.1, -0.7, 2.3};
  const Case cases[] = {
      {"a profile along y", upright(0.1, 0.0, 0.3), {0.2, 0.0, -0.1}, {0.0, 2.0, 0.0}},
      {"a cone about its axis", cone(0.1, 0.0, 0.2, 0.3), {0.2, 0.3, -0.1}, {0.0, 0.0, 3.0}},
      {"a drum about its axis", lying_cylinder(0.1, 0.0, 0.2), {0.2, 0.0, 0.1}, {0.0, 3.0, 0.0}},
      {"a rectangle", rectangle({0.1, 0.2, 0.3}, {0.1, 0, 0}, {0, 0.3, 0}), {0.1, 0.2, 0.3}, turn},
  };
  Random random(3, Purpose::grain_position);
  for (const Case& c : cases) {
    CAPTURE(c.name);
    Surface moved = c.surface;
    moved.velocity = c.velocity;
    moved.spin = c.spin;
    const Vec3 pivot = moved.pivot;
    constexpr int steps = 1000;
    constexpr double dt = 1e-3;
    for (int k = 0; k < steps; ++k) advance(moved, dt);
    const double seconds = steps * dt, angle = norm(c.spin) * seconds;
    const Vec3 axis = (std::sin(0.5 * angle) / norm(c.spin)) * c.spin;
    const Quaternion turned_by{std::cos(0.5 * angle), axis.x, axis.y, axis.z};
    for (int k = 0; k < 20; ++k) {
      const Vec3 centre = random_vector(random, 0.5);
      const Vec3 there = pivot + seconds * c.velocity + turned(turned_by, centre - pivot);
      const Vec3 before = offset_from(c.surface, centre), after = offset_from(moved, there);
      CHECK(norm(after - turned(turned_by, before)) < 1e-9);
    }
  }
}

TEST_CASE("a belt and a drum stay where they are, and their points move", "[engine]") {
  Surface belt = plane(0.0);
  belt.velocity = {0.3, 0.0, 0.0};
  belt.belt = true;
  advance(belt, 1.0);
  CHECK(offset_from(belt, {0.0, 0.0, 0.1}) == Vec3{0.0, 0.0, 0.1});
  CHECK(velocity_at(belt, {5.0, 0.0, 0.0}) == Vec3{0.3, 0.0, 0.0});
  CHECK(fastest(belt) == 0.0);
  Surface drum = lying_cylinder(0.1, 0.0, 0.0);
  drum.spin = {0.0, 2.0, 0.0};
  CHECK(fastest(drum) == 0.0);
  const Vec3 lowest = velocity_at(drum, {0.0, 0.7, -0.1});
  CHECK(lowest.x == Approx(-0.2));
  CHECK(norm({0.0, lowest.y, lowest.z}) < 1e-15);
}

TEST_CASE("what walls do to grains and grains to walls are opposite", "[engine]") {
  World world(ContactModel(parameters(sticky)), {.time_step = 2e-5, .period = {}});
  constexpr double side = 0.05;
  world.change_surfaces() = {plane(0.0),
                             upright(0.0, -1.0, 1.0),
                             upright(side, -1.0, 1.0),
                             lying_cylinder(0.04, 0.025, 0.02, MaterialId::grain),
                             plane(0.06)};
  world.drive(4, {0.0, 0.0, -0.2});
  world.drive(3, {}, {0.0, 8.0, 0.0});
  scatter(world, 80, side, 0.004, 0.05, 5);
  double largest = 0.0;
  for (int step = 0; step < 400; ++step) {
    const Vec3 before = momentum(world);
    world.step();
    Vec3 expected;
    for (const GrainRow& g : world.grains().rows) expected += mass(g) * world.gravity();
    for (const WallLoad& load : world.wall_loads()) {
      expected -= load.force;
      largest = std::max(largest, norm(load.force));
    }
    const Vec3 rate = (1.0 / world.time_step()) * (momentum(world) - before);
    CHECK(norm(rate - expected) < 1e-9 * std::max(1.0, norm(expected)));
  }
  CHECK(largest > 0.1);
}

TEST_CASE("a floor bears the weight of what lies on it", "[engine]") {
  World world(ContactModel(parameters(sticky)), {.time_step = 5e-5, .period = {0.03, 0.03, 0.0}});
  world.change_surfaces() = {plane(0.0)};
  Random random(1, Purpose::grain_position);
  double weight = 0.0;
  for (int k = 0; k < 64; ++k) {
    GrainRow grain = sphere(radius, 1228.0);
    grain.x = 0.0075 * (k % 4 + random.uniform(0.4, 0.6));
    grain.y = 0.0075 * (k / 4 % 4 + random.uniform(0.4, 0.6));
    grain.z = 0.0075 * (k / 16 + 0.5);  // NOLINT(bugprone-integer-division): the layer
    weight += mass(grain) * 9.81;
    world.add(grain);
  }
  for (int step = 0; step < 20000; ++step) world.step();
  double force = 0.0;
  constexpr int steps = 2000;
  for (int step = 0; step < steps; ++step) {
    world.step();
    force += world.wall_loads()[0].force.z / steps;
  }
  CHECK(-force == Approx(weight).epsilon(1e-3));
}

TEST_CASE("the torque on a wall is that of its forces about its pivot", "[engine]") {
  // A grain presses on a plate that may turn about an axis far from it, without friction.
  World world = repose::tests::weightless({}, 2e-5);
  world.change_surfaces() = {rectangle({0.1, 0.0, 0.0}, {0.1, 0, 0}, {0, 0.05, 0})};
  GrainRow grain = sphere(radius, 1228.0);
  grain.x = 0.15;
  grain.y = 0.02;
  grain.z = 0.99 * radius;
  world.add(grain);
  world.step();
  const WallLoad load = world.wall_loads()[0];
  CHECK(load.force.z < 0.0);
  CHECK(load.torque.x == Approx(0.02 * load.force.z));
  CHECK(load.torque.y == Approx(-0.15 * load.force.z));
  CHECK(std::abs(load.torque.z) < 1e-18);
}

TEST_CASE("a bed on a floor that rises steadily is the bed on a floor at rest", "[engine]") {
  const auto bed = [](double speed) {
    World world(ContactModel(parameters(sticky)), {.time_step = 4e-5, .period = {0.03, 0.03, 0.0}});
    world.change_surfaces() = {plane(0.0)};
    world.drive(0, {0.0, 0.0, speed});
    for (int k = 0; k < 48; ++k) {
      GrainRow grain = sphere(radius, 1228.0);
      const int layer = k / 16, line = k / 4 % 4;
      grain.x = 0.0075 * (k % 4) + 0.001 * layer;
      grain.y = 0.0075 * line;
      grain.z = 0.0075 * (layer + 0.5);
      grain.vz = speed;
      world.add(grain);
    }
    for (int step = 0; step < 1500; ++step) world.step();
    std::vector<Vec3> centres(world.grains().size());
    for (std::size_t k = 0; k < centres.size(); ++k) {
      centres[world.grains().ids[k]] =
          world.grains().rows[k].centre() - Vec3{0.0, 0.0, speed * world.time()};
    }
    return centres;
  };
  const auto still = bed(0.0), rising = bed(1.5);
  for (std::size_t k = 0; k < still.size(); ++k) CHECK(norm(still[k] - rising[k]) < 1e-7);
}

TEST_CASE("a ball on a belt ends with two sevenths of its speed", "[engine]") {
  // Sliding friction F gives v = F t / m and surface speed (1 + 5/2) F t / m, until that is u.
  // Stiff, so that the overlap does not shorten the arm.
  const GrainLaw law{.shear_modulus = 41.7e6, .restitution = 0.5, .sliding = 0.3};
  World world(ContactModel(parameters(law)), {.time_step = 1e-5, .period = {}});
  world.change_surfaces() = {plane(0.0)};
  world.change_surfaces()[0].belt = true;
  world.drive(0, {0.7, 0.0, 0.0});
  GrainRow grain = sphere(radius, 1228.0);
  grain.z = radius;
  world.add(grain);
  for (int step = 0; step < 40000; ++step) world.step();
  CHECK(world.grains().rows[0].vx == Approx(0.2).epsilon(2e-3));
}

TEST_CASE("a drum's rib lifts a grain over the axis", "[engine]") {
  World world(ContactModel(parameters(sticky)), {.time_step = 4e-5, .period = {0.0, 0.02, 0.0}});
  auto walls = lying_ribs(4, 0.05, 0.02, 0.0, 0.05);
  walls.push_back(lying_cylinder(0.05, 0.0, 0.05));
  world.change_surfaces() = walls;
  for (std::size_t k = 0; k < walls.size(); ++k) world.drive(k, {}, {0.0, 2.0, 0.0});
  GrainRow grain = sphere(radius, 1228.0);
  grain.x = 0.01;
  grain.y = 0.01;
  grain.z = 0.006;
  world.add(grain);
  double highest = 0.0;
  for (int step = 0; step < 40000; ++step) {
    world.step();
    const GrainRow& row = world.grains().rows[0];
    highest = std::max(highest, row.z);
    REQUIRE(std::hypot(row.x, row.z - 0.05) < 0.05);
  }
  CHECK(highest > 0.05);
}
