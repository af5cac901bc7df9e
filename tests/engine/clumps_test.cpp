// Motion of clumps against the mechanics of rigid bodies.
#include "engine/clumps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <catch2/catch.hpp>

#include "engine/instrument.hpp"
#include "engine/random.hpp"
#include "engine/soybean_shapes.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;
using repose::tests::GrainLaw;
using repose::tests::weightless;

namespace {

constexpr double g = 9.81;
constexpr double density = 1228.0;  // kg/m3

ClumpShape shape_of(const std::vector<ClumpMember>& members) {
  const auto shape = clump_shape(members);
  if (!shape) FAIL(shape.error());
  return *shape;
}

/// Two spheres of radius r that half overlap, along x.
ClumpShape rod(double r) { return shape_of({{{}, r}, {{r, 0, 0}, r}}); }

/// Three unlike spheres: three unlike principal moments.
ClumpShape odd_one() {
  return shape_of({{{0, 0, 0}, 3e-3}, {{3e-3, 0, 0}, 2e-3}, {{-1e-3, 2.5e-3, 0}, 1.5e-3}});
}

/// The turn about y by an angle.
Quaternion about_y(double angle) { return {std::cos(angle / 2), 0.0, std::sin(angle / 2), 0.0}; }

/// Principal moments of inertia, kg m2.
Vec3 inertia_of(const ClumpBody& b) {
  return {1.0 / b.inverse_inertia.x, 1.0 / b.inverse_inertia.y, 1.0 / b.inverse_inertia.z};
}

void run(World& world, double seconds) {
  const auto steps = static_cast<int>(std::lround(seconds / world.time_step()));
  for (int i = 0; i < steps; ++i) world.step();
}

const ClumpBody& body(const World& world, std::size_t index = 0) {
  return world.clumps().bodies()[index];
}

/// Row of a sphere by its id.
const GrainRow& sphere_of(const World& world, std::uint32_t id) {
  const Grains& grains = world.grains();
  const auto at = std::ranges::find(grains.ids, id) - grains.ids.begin();
  return grains.rows[static_cast<std::size_t>(at)];
}

std::array<double, 3> sorted(const Vec3& v) {
  std::array result{v.x, v.y, v.z};
  std::ranges::sort(result);
  return result;
}

/// Two-sphere clumps in random orientations above a plane, periodic sideways.
World column(const ParameterSet& set, int side, int layers, std::uint64_t seed) {
  const ClumpShape shape = *clump_shape(soybean_shapes[1]);
  const double d = 2.0 * shape.bounding_radius;
  const double time_step =
      0.2 * rayleigh_time(2.85e-3, ContactModel(set).material(MaterialId::grain));
  World world(ContactModel(set), {.time_step = time_step, .period = {side * d, side * d, 0}});
  world.change_surfaces().push_back(plane(0.0));
  Random random(seed, Purpose::grain_position);
  for (int k = 0; k < layers; ++k) {
    for (int i = 0; i < side; ++i) {
      for (int j = 0; j < side; ++j) {
        world.add_clump(shape,
                        {.density = density,
                         .centre = {(i + 0.5) * d, (j + 0.5) * d, (k + 0.6) * 1.01 * d},
                         .orientation = random_orientation(random),
                         .velocity = {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0.0}});
      }
    }
  }
  return world;
}

}  // namespace

TEST_CASE("a clump tumbling without torque keeps its energy and angular momentum", "[engine]") {
  World world = weightless({}, 1e-5);
  const ClumpShape shape = odd_one();
  world.add_clump(shape,
                  {.density = density, .velocity = {0.3, 0, 0}, .spin = {60.0, 80.0, -40.0}});
  const double energy = world.kinetic_energy();
  const Vec3 momentum = body(world).angular_momentum;
  double worst_energy = 0.0, worst_momentum = 0.0, least = 1e9, most = -1e9;
  for (int i = 0; i < 100000; ++i) {
    world.step();
    worst_energy = std::max(worst_energy, std::abs(world.kinetic_energy() / energy - 1.0));
    // From the spin as contacts see it, not as it is stored.
    const Quaternion back = conjugate(body(world).orientation);
    const Vec3 w = turned(back, world.grains().rows[0].spin());
    const Vec3 inertia = inertia_of(body(world));
    const double now = norm({inertia.x * w.x, inertia.y * w.y, inertia.z * w.z});
    worst_momentum = std::max(worst_momentum, std::abs(now / norm(momentum) - 1.0));
    least = std::min(least, w.x);
    most = std::max(most, w.x);
  }
  CHECK(worst_energy < 1e-6);
  CHECK(worst_momentum < 1e-6);
  CHECK(most - least > 20.0);  // it did tumble
  for (std::uint32_t id = 1; id < 3; ++id) {
    const Vec3 now = sphere_of(world, id).centre() - sphere_of(world, 0).centre();
    CHECK(norm(now) ==
          Approx(norm(shape.members[id].centre - shape.members[0].centre)).epsilon(1e-12));
  }
}

TEST_CASE("a clump spun about its middle axis turns over in the period of Jacobi's functions",
          "[engine]") {
  // Landau & Lifshitz 1976, Mechanics, section 37, for M^2 < 2 E I2 with axes 1 and 3 exchanged.
  World world = weightless({}, 1e-5);
  const ClumpShape shape = odd_one();
  const auto [i1, i2, i3] = sorted(density * shape.inertia);
  const std::array moments{shape.inertia.x, shape.inertia.y, shape.inertia.z};
  const auto axis_of = [&](double moment) {
    std::array<double, 3> axis{};
    for (std::size_t k = 0; k < 3; ++k) {
      axis[k] = std::abs(density * moments[k] - moment) < 1e-9 * moment ? 1.0 : 0.0;
    }
    return turned(shape.axes, {axis[0], axis[1], axis[2]});
  };
  const double w0 = 100.0, tilt = 2.0;
  world.add_clump(shape, {.density = density, .spin = w0 * axis_of(i2) + tilt * axis_of(i1)});
  const double twice_energy = i1 * tilt * tilt + i2 * w0 * w0;
  const double squared = i1 * i1 * tilt * tilt + i2 * i2 * w0 * w0;
  const double rate = std::sqrt((i2 - i1) * (twice_energy * i3 - squared) / (i1 * i2 * i3));
  const double modulus = std::sqrt((i3 - i2) * (squared - twice_energy * i1) /
                                   ((i2 - i1) * (twice_energy * i3 - squared)));
  const double half_period = 2.0 * std::comp_ellint_1(modulus) / rate;

  std::vector<double> crossings;
  double before = w0;
  while (crossings.size() < 4 && world.time() < 10.0) {
    world.step();
    const Vec3 w = turned(conjugate(body(world).orientation), spin(body(world)));
    const double now = dot(turned(conjugate(shape.axes), axis_of(i2)), w);
    if (before * now < 0.0) {
      crossings.push_back(crossing(world.time() - world.time_step(), world.time(), before, now, 0));
    }
    before = now;
  }
  REQUIRE(crossings.size() == 4);
  for (std::size_t k = 1; k < crossings.size(); ++k) {
    CHECK(crossings[k] - crossings[k - 1] == Approx(half_period).epsilon(1e-5));
  }
}

TEST_CASE("a clump of one sphere moves as the sphere", "[engine]") {
  const GrainLaw law{.restitution = 0.6, .sliding = 0.4};
  const double r = 0.5 * law.diameter;
  const auto bounce = [&](bool clump) {
    World world(ContactModel(repose::tests::parameters(law)), {.time_step = 2e-5, .period = {}});
    world.change_surfaces().push_back(plane(0.0));
    const Vec3 start{0, 0, 0.02}, velocity{0.5, 0.2, 0}, turning{10, 20, 30};
    if (clump) {
      world.add_clump(
          shape_of({{{}, r}}),
          {.density = law.density, .centre = start, .velocity = velocity, .spin = turning});
    } else {
      GrainRow grain = sphere(r, law.density);
      grain.z = start.z;
      grain.vx = velocity.x, grain.vy = velocity.y;
      grain.wx = turning.x, grain.wy = turning.y, grain.wz = turning.z;
      world.add(grain);
    }
    run(world, 0.2);
    return world.grains().rows[0];
  };
  const GrainRow a = bounce(false);
  const GrainRow b = bounce(true);
  CHECK(norm(b.centre() - a.centre()) < 1e-9 * norm(a.centre()));
  CHECK(norm(b.velocity() - a.velocity()) < 1e-8 * norm(a.velocity()));
  CHECK(norm(b.spin() - a.spin()) < 1e-8 * norm(a.spin()));
}

TEST_CASE("a clump at rest without gravity stays at rest, exactly", "[engine]") {
  World world = weightless({.restitution = 0.6, .sliding = 0.5, .rolling = 0.1}, 1e-5);
  Random random(3, Purpose::grain_position);
  world.add_clump(*clump_shape(soybean_shapes[3]),
                  {.density = density, .orientation = random_orientation(random)});
  world.step();
  const std::vector<GrainRow> before = world.grains().rows;
  CHECK(world.pairs().size() == 0);  // members are no candidates, though they overlap
  for (int i = 0; i < 1000; ++i) world.step();
  CHECK(world.contacts() == 0);
  CHECK(world.kinetic_energy() == 0.0);
  for (std::size_t k = 0; k < before.size(); ++k) {
    CHECK(norm(world.grains().rows[k].centre() - before[k].centre()) < 1e-15);
    CHECK(norm(world.grains().rows[k].velocity()) == 0.0);
  }
}

TEST_CASE("a clump falls as any grain falls", "[engine]") {
  World world(ContactModel(repose::tests::reference_grain()), {.time_step = 1e-4, .period = {}});
  world.add_clump(odd_one(), {.density = density, .centre = {0, 0, 1.0}, .spin = {0, 50, 20}});
  run(world, 0.2);
  CHECK(body(world).centre.z == Approx(1.0 - 0.5 * g * 0.04).margin(0.5 * g * 0.2 * 1e-4 * 1.01));
  CHECK(body(world).velocity.z == Approx(-g * 0.2).epsilon(1e-12));
}

TEST_CASE("an elastic collision of clumps keeps energy and both momenta", "[engine]") {
  const double offset = GENERATE(0.0, 2e-3);
  CAPTURE(offset);
  World world = weightless({}, 1e-6);
  world.add_clump(rod(3e-3),
                  {.density = density,
                   .centre = {-6e-3, 0, offset},
                   .orientation = about_y(0.4),
                   .velocity = {0.5, 0, 0}});
  world.add_clump(
      odd_one(),
      {.density = density, .centre = {6e-3, 0, 0}, .velocity = {-0.5, 0, 0}, .spin = {0, 30, 10}});
  const auto momenta = [&] {
    std::pair<Vec3, Vec3> sum;
    for (const ClumpBody& b : world.clumps().bodies()) {
      sum.first += b.mass * b.velocity;
      sum.second += b.angular_momentum + cross(b.centre, b.mass * b.velocity);
    }
    return sum;
  };
  const double energy = world.kinetic_energy();
  const auto [p0, l0] = momenta();
  const double spin_before = norm(spin(body(world)));
  run(world, 0.02);
  const auto [p1, l1] = momenta();
  CHECK(norm(spin(body(world))) > spin_before + 5.0);  // they did meet, off centre
  CHECK(world.contacts() == 0);
  CHECK(world.kinetic_energy() == Approx(energy).epsilon(1e-4));
  CHECK(norm(p1 - p0) < 1e-10 * body(world).mass * 0.5);
  CHECK(norm(l1 - l0) < 1e-4 * norm(l0));
}

TEST_CASE("a rod that meets a wall on one end rebounds as a rigid body", "[engine]") {
  // Impulse J = 2 m v / (1 + m x^2 / I) at a distance x beside the centre of mass: no friction,
  // e = 1.
  const double r = 3e-3, speed = 0.1;
  const ClumpShape shape = shape_of({{{}, r}, {{2 * r, 0, 0}, r}});
  for (const double angle : {0.0, 0.3, 0.8, 1.2}) {
    CAPTURE(angle);
    World world = weightless({.shear_modulus = 1e9}, 2e-8);
    world.change_surfaces().push_back(plane(0.0));
    const double x = r * std::cos(angle), rise = r * std::sin(angle);
    world.add_clump(shape,
                    {.density = density,
                     .centre = {0, 0, r + rise + 1e-9},
                     .orientation = about_y(angle),  // the end at +x is the lower
                     .velocity = {0, 0, -speed}});
    const ClumpBody start = body(world);
    const double inertia = sorted(inertia_of(start))[2];
    double touched = 0.0;
    do {
      world.step();
      touched += world.time_step();
    } while (touched < 1e-6 || world.contacts() > 0);
    const ClumpBody& end = body(world);
    if (angle == 0.0) {  // both ends at once: no turn
      CHECK(end.velocity.z == Approx(speed).epsilon(1e-4));
      CHECK(norm(spin(end)) < 1e-6 * speed / r);
      continue;
    }
    const double impulse = 2 * start.mass * speed / (1 + start.mass * x * x / inertia);
    CHECK(end.velocity.z == Approx(-speed + impulse / start.mass).epsilon(2e-3).margin(1e-4));
    CHECK(spin(end).y == Approx(-x * impulse / inertia).epsilon(2e-3));
  }
}

TEST_CASE("a block on an incline slides at g (sin - mu cos), or rests", "[engine]") {
  const double mu = 0.4, r = 3e-3;
  const ClumpShape block =
      shape_of({{{0, 0, 0}, r}, {{2 * r, 0, 0}, r}, {{0, 2 * r, 0}, r}, {{2 * r, 2 * r, 0}, r}});
  for (const double slope : {0.3, 0.38, 0.42, 0.6}) {
    CAPTURE(slope);
    const double angle = std::atan(slope);
    const GrainLaw law{.restitution = 0.5, .sliding = mu};
    World world(ContactModel(repose::tests::parameters(law)),
                {.time_step = 1e-5,
                 .period = {},
                 .gravity = {g * std::sin(angle), 0, -g * std::cos(angle)}});
    world.change_surfaces().push_back(plane(0.0));
    world.add_clump(block, {.density = density, .centre = {0, 0, r}});
    run(world, 0.1);  // settled on its feet
    const double before = body(world).velocity.x;
    run(world, 0.2);
    const double expected = std::max(0.0, g * (std::sin(angle) - mu * std::cos(angle)));
    CHECK((body(world).velocity.x - before) / 0.2 == Approx(expected).epsilon(0.01).margin(1e-4));
    CHECK(norm(spin(body(world))) < 0.01);
  }
}

TEST_CASE("a bed of clumps comes to rest, and stays", "[engine]") {
  World world = column(repose::tests::reference_grain(), 4, 5, 1);
  run(world, 1.0);
  const double count = static_cast<double>(world.grain_count());
  CHECK(world.grain_count() == 80);
  CHECK(world.grains().size() == 160);
  CHECK(world.kinetic_energy() / count < 1e-9);  // the definition of rest
  const auto height = [&] {
    double sum = 0.0;
    for (const ClumpBody& b : world.clumps().bodies()) sum += b.centre.z;
    return sum / count;
  };
  const double before = height();
  run(world, 0.5);
  CHECK(world.kinetic_energy() / count < 1e-9);
  CHECK(std::abs(height() - before) < 1e-5);
  CHECK(world.largest_overlap() < 0.05);
}

TEST_CASE("a world with clumps gives equal bits for equal input", "[engine]") {
  const auto final_state = [] {
    World world = column(repose::tests::reference_grain(), 4, 3, 7);
    run(world, 0.3);
    return world.grains().rows;
  };
  const auto a = final_state();
  const auto b = final_state();
  REQUIRE(a.size() == b.size());
  CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(GrainRow)) == 0);
}

TEST_CASE("clumps that meet across a periodic side meet as within", "[engine]") {
  const GrainLaw law{.restitution = 0.6, .sliding = 0.4, .rolling = 0.05};
  const double period = 0.05;
  const auto collision = [&](double shift) {
    World world(ContactModel(repose::tests::parameters(law)),
                {.time_step = 1e-5, .period = {period, period, 0}, .gravity = {}});
    for (const double side : {-1.0, 1.0}) {
      // Of unlike spins: between like ones the rolling couple's direction is a rounding error's.
      world.add_clump(rod(3e-3),
                      {.density = density,
                       .centre = {0.025 + shift + side * 6e-3, 0.025 + shift + side * 1e-3, 0.0},
                       .orientation = about_y(0.3),
                       .velocity = {-0.5 * side, 0, 0},
                       .spin = {0, 10 * side, 30}});
    }
    run(world, 0.3);  // long enough to meet again round the period
    CHECK(world.rebuilds() > 5);
    CHECK(world.rebuilds() < 2000);  // of 30000 steps: rows keep to the image they were sorted in
    return body(world);
  };
  const ClumpBody within = collision(0.0);
  const ClumpBody across = collision(0.0249);
  REQUIRE(norm(spin(within) - Vec3{0, -10, 30}) > 5.0);
  CHECK(norm(across.velocity - within.velocity) < 1e-9);
  CHECK(norm(spin(across) - spin(within)) < 1e-6);
}

TEST_CASE("a clump leaves as a whole, and the others go on undisturbed", "[engine]") {
  const auto scene = [](bool with_more) {
    World world = weightless({.restitution = 0.6, .sliding = 0.3}, 1e-5);
    for (int k = 0; k < 3; ++k) {
      const bool stays = k == 1;
      if (!stays && !with_more) continue;
      world.add_clump(odd_one(),
                      {.density = density,
                       .centre = {0.05 * k, 0, 0},
                       .velocity = {stays ? 0.5 : 0.0, 0, 0},
                       .spin = {40, 50, 0}});
    }
    GrainRow grain = sphere(3e-3, density);
    grain.x = 0.065;
    world.add(grain);
    return world;
  };
  World world = scene(true);
  run(world, 5e-3);
  CHECK(world.grain_count() == 4);
  CHECK(world.inserted_grains() == 4);
  CHECK(world.inserted() == 10);
  const double total = mass_where(world, [](const Vec3&) { return true; });
  const double clump = body(world).mass;
  CHECK(total == Approx(3 * clump + mass(sphere(3e-3, density))).epsilon(1e-12));
  // The members of the last straddle x = 0.1; its centre of mass is there.
  CHECK(world.remove([](const GrainRow& row) { return row.x < 0.02 || row.x > 0.0999; }) == 2);
  CHECK(world.grain_count() == 2);
  CHECK(world.grains().size() == 4);
  run(world, 0.03);

  World alone = scene(false);
  run(alone, 0.035);
  REQUIRE(world.clumps().bodies().size() == 1);
  CHECK(std::abs(body(alone).velocity.x - 0.5) > 0.05);  // it met the sphere
  CHECK(norm(body(world).centre - body(alone).centre) < 1e-12);
  CHECK(norm(spin(body(world)) - spin(body(alone))) < 1e-9);
}

TEST_CASE("a clump twice as large has eight times the mass and 32 times the inertia", "[engine]") {
  World world = weightless({}, 1e-5);
  for (const double scale : {1.0, 2.0}) {
    world.add_clump(odd_one(), {.density = density, .scale = scale, .centre = {0.1 * scale, 0, 0}});
  }
  CHECK(body(world, 1).mass == Approx(8 * body(world).mass).epsilon(1e-12));
  CHECK(inertia_of(body(world, 1)).y == Approx(32 * inertia_of(body(world)).y).epsilon(1e-12));
  CHECK(sphere_of(world, 3).radius == 2 * sphere_of(world, 0).radius);
}
