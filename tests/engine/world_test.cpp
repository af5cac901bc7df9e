// Motion of few grains against closed forms, and the properties that hold for any bed.
#include "engine/world.hpp"

#include <cmath>
#include <cstring>

#include <catch2/catch.hpp>

#include "engine/any_machine.hpp"
#include "engine/random.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;
using repose::tests::GrainLaw;

namespace {

constexpr double g = 9.81;

void run(World& world, double seconds) {
  const auto steps = static_cast<int>(std::lround(seconds / world.time_step()));
  for (int i = 0; i < steps; ++i) world.step();
}

/// A loose column of grains in a periodic box over a plane.
World column(const ParameterSet& set, int side, int layers, std::uint64_t seed) {
  const double d = 6.496e-3;
  const double time_step =
      0.2 * rayleigh_time(d / 2, ContactModel(set).material(MaterialId::grain));
  World world(ContactModel(set), {.time_step = time_step, .period = {side * d, side * d, 0}});
  world.change_surfaces().push_back(plane(0.0));
  Random random(seed, Purpose::grain_position);
  for (int k = 0; k < layers; ++k) {
    for (int i = 0; i < side - 1; ++i) {
      for (int j = 0; j < side - 1; ++j) {
        GrainRow grain = sphere(d / 2, 1228);
        const double pitch = side * d / (side - 1);
        grain.x = (i + 0.5) * pitch + random.uniform(-0.05, 0.05) * d;
        grain.y = (j + 0.5) * pitch + random.uniform(-0.05, 0.05) * d;
        grain.z = (k + 0.6) * 1.1 * d;
        grain.vx = random.uniform(-0.1, 0.1);
        world.add(grain);
      }
    }
  }
  return world;
}

}  // namespace

TEST_CASE("a grain in free fall follows the parabola", "[engine]") {
  World world(ContactModel(repose::tests::reference_grain()), {.time_step = 1e-4, .period = {}});
  GrainRow grain = sphere(3e-3, 1228);
  grain.z = 1.0;
  grain.vx = 0.5;
  world.add(grain);
  run(world, 0.2);
  CHECK(world.grains().rows[0].x == Approx(0.1).epsilon(1e-12));
  // Leapfrog from rest: half a step's kick too much.
  CHECK(world.grains().rows[0].z ==
        Approx(1.0 - 0.5 * g * 0.04).margin(0.5 * g * 0.2 * 1e-4 * 1.01));
}

TEST_CASE("an elastic stack keeps its energy", "[engine]") {
  const GrainLaw law{};
  World world(ContactModel(repose::tests::parameters(law)), {.time_step = 1e-5, .period = {}});
  world.change_surfaces().push_back(plane(0.0));
  const double r = 0.5 * law.diameter;
  for (int k = 0; k < 5; ++k) {
    GrainRow grain = sphere(r, law.density);
    grain.z = r * (1 + 2 * k);
    world.add(grain);
  }
  const double mass_one = mass(world.grains().rows[0]);
  const auto energy = [&] {
    double stored = 0.0;
    const auto& rows = world.grains().rows;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double half = rows[k].vz - 0.0;
      stored += mass_one * g * rows[k].z + 0.5 * mass_one * half * half;
      const double below = k == 0 ? 0.0 : rows[k - 1].z;
      const double overlap = k == 0 ? r - rows[k].z : 2 * r - (rows[k].z - below);
      if (overlap <= 0.0) continue;
      const auto& elastic =
          world.model().law(k == 0 ? MaterialId::wall : MaterialId::grain).elastic;
      const double radius = k == 0 ? r : r / 2;
      stored += 8.0 / 15.0 * elastic.modulus * std::sqrt(radius) * std::pow(overlap, 2.5);
    }
    return stored;
  };
  const double before = energy();
  double worst = 0.0;
  for (int i = 0; i < 200000; ++i) {
    world.step();
    if (i % 1000 == 999) worst = std::max(worst, std::abs(energy() / before - 1.0));
  }
  // Velocities lag half a step: that is 1e-5 relative here, and must not grow.
  CHECK(worst < 2e-4);
}

TEST_CASE("momentum and angular momentum are kept in a collision off centre", "[engine]") {
  const GrainLaw law{.restitution = 0.6, .sliding = 0.4, .rolling = 0.05};
  World world = repose::tests::weightless(law, 1e-6);
  const double r = 0.5 * law.diameter;
  GrainRow a = sphere(r, law.density);
  a.vx = 1.0;
  a.wz = 50.0;
  GrainRow b = sphere(0.5 * r, law.density);
  b.x = 1.6 * r;
  b.y = 0.7 * r;
  world.add(a);
  world.add(b);
  const auto momentum = [&] {
    Vec3 p, l;
    for (const GrainRow& grain : world.grains().rows) {
      p += mass(grain) * grain.velocity();
      l += cross(grain.centre(), mass(grain) * grain.velocity());
      l += (1 / grain.inverse_inertia) * grain.spin();
    }
    return std::pair{p, l};
  };
  const auto [p0, l0] = momentum();
  run(world, 5e-3);
  const auto [p1, l1] = momentum();
  CHECK(norm(p1 - p0) < 1e-12 * norm(p0));
  CHECK(std::abs(l1.z - l0.z) < 1e-6 * std::abs(l0.z));
  CHECK(norm(world.grains().rows[1].spin()) > 1.0);  // it did happen
}

TEST_CASE("a bed comes to rest, and stays", "[engine]") {
  World world = column(repose::tests::reference_grain(), 6, 6, 1);
  run(world, 1.0);
  const double count = static_cast<double>(world.grains().size());
  CHECK(world.grains().size() == 150);
  CHECK(world.kinetic_energy() / count < 1e-9);  // the definition of rest
  const auto height = [&] {
    double sum = 0.0;
    for (const GrainRow& grain : world.grains().rows) sum += grain.z;
    return sum / count;
  };
  const double before = height();
  run(world, 0.5);
  CHECK(world.kinetic_energy() / count < 1e-9);
  CHECK(std::abs(height() - before) < 1e-5);  // 1.5 thousandths of a grain
}

TEST_CASE("equal input gives equal bits, on every instruction set", "[engine]") {
  const auto final_state = [](InstructionSet set) {
    use_instruction_set(set);
    ParameterSet soybean = repose::tests::reference_grain();
    soybean.set({"elastic_rolling_resistance.coefficient", {MaterialId::grain, MaterialId::grain}},
                0.02);
    World world = column(soybean, 5, 5, 7);
    run(world, 0.3);
    return world.grains().rows;
  };
  const InstructionSet best = instruction_set();
  const auto expected = final_state(best);
  for (const auto set : {InstructionSet::base, InstructionSet::avx2, InstructionSet::avx512}) {
    CAPTURE(static_cast<int>(set));
    const auto rows = final_state(set);
    REQUIRE(rows.size() == expected.size());
    CHECK(std::memcmp(rows.data(), expected.data(), rows.size() * sizeof(GrainRow)) == 0);
  }
  use_instruction_set(best);
}

TEST_CASE("a collision across a periodic side is the collision within", "[engine]") {
  const GrainLaw law{.restitution = 0.6, .sliding = 0.4, .rolling = 0.05};
  const double period = 0.05, r = 0.5 * law.diameter;
  const auto collision = [&](double shift) {
    World world(ContactModel(repose::tests::parameters(law)),
                {.time_step = 1e-5, .period = {period, period, 0}, .gravity = {}});
    for (const double side : {-1.0, 1.0}) {
      GrainRow grain = sphere(r, law.density);
      grain.x = 0.025 + shift + side * 1.2 * r;
      grain.y = 0.025 + shift + side * 0.3 * r;
      grain.vx = -0.5 * side;
      grain.wz = 30.0;
      world.add(grain);
    }
    run(world, 0.02);
    const auto& g = world.grains();
    return g.rows[g.ids[0] == 0 ? 0 : 1];
  };
  const GrainRow within = collision(0.0);
  const GrainRow across = collision(0.025);
  REQUIRE(std::abs(within.vy) > 0.01);  // it was oblique
  CHECK(across.vx == Approx(within.vx).epsilon(1e-9));
  CHECK(across.vy == Approx(within.vy).epsilon(1e-9));
  CHECK(across.wz == Approx(within.wz).epsilon(1e-9));
}

TEST_CASE("turning the scene turns the answer", "[engine]") {
  // Gravity along x with a wall at x = 0 against gravity along z with a wall at z = 0.
  const GrainLaw law{.restitution = 0.6, .sliding = 0.4, .rolling = 0.1};
  const auto bounce = [&law](bool sideways) {
    World world(
        ContactModel(repose::tests::parameters(law)),
        {.time_step = 2e-5, .period = {}, .gravity = sideways ? Vec3{-g, 0, 0} : Vec3{0, 0, -g}});
    world.change_surfaces().push_back(sideways ? upright(0.0, -1.0, 1.0) : plane(0.0));
    GrainRow grain = sphere(0.5 * law.diameter, law.density);
    (sideways ? grain.x : grain.z) = 0.01;
    (sideways ? grain.z : grain.x) = 0.0;
    (sideways ? grain.vz : grain.vx) = 0.3;
    world.add(grain);
    run(world, 0.3);
    const GrainRow& end = world.grains().rows[0];
    return sideways ? Vec3{end.z, end.vz, -end.wy} : Vec3{end.x, end.vx, end.wy};
  };
  const Vec3 a = bounce(false);
  const Vec3 b = bounce(true);
  CHECK(a.x == Approx(b.x).epsilon(1e-12));
  CHECK(a.y == Approx(b.y).epsilon(1e-12));
  CHECK(a.z == Approx(b.z).epsilon(1e-12));
}

TEST_CASE("a settled bed holds less than a kilobyte for each grain", "[engine]") {
  World world = column(repose::tests::reference_grain(), 12, 10, 1);
  run(world, 0.5);
  CHECK(world.bytes_per_grain() < 1000.0);
}
