// Energy in equals energy stored and dissipated, part by part; and the ledger sees a broken law.
#include <cmath>
#include <memory>
#include <string>

#include <catch2/catch.hpp>

#include "engine/random.hpp"
#include "tests/engine/verification/energy_ledger.hpp"
#include "tests/engine/verification/table.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;
using namespace repose::tests;

namespace {

/// A closed can of grains that turns end over end once a second, its floor a belt, its mantle
/// turning about the can's axis.
World can_of_grains(const GrainLaw& law, double time_step) {
  constexpr double radius = 0.02, height = 0.04, pitch = 7.5e-3;
  World world(ContactModel(parameters(law)), {.time_step = time_step, .period = {}});
  auto& walls = world.change_surfaces();
  walls.push_back(cylinder(radius, 0.0, height));
  walls.push_back(disc(radius, 0.0, MaterialId::grain));
  walls.push_back(disc(radius, height));
  walls[0].spin = {0.0, 0.0, 5.0};
  walls[1].velocity = {0.3, 0.0, 0.0};
  walls[1].belt = true;
  Random random(5, Purpose::grain_position);
  for (int k = 0; k < 45; ++k) {
    const int column = k % 9, row = column / 3, layer = k / 9;
    GrainRow grain = sphere(0.5 * law.diameter * random.uniform(0.8, 1.0), law.density);
    grain.x = pitch * (column % 3 - 1);
    grain.y = pitch * (row - 1);
    grain.z = 4e-3 + pitch * layer;
    grain.vx = random.uniform(-0.2, 0.2);
    grain.wz = random.uniform(-20.0, 20.0);
    world.add(grain);
  }
  world.turn_gravity(2.0 * unit::pi);
  return world;
}

EnergyAccount tumble(const GrainLaw& law,
                     double seconds,
                     double time_step,
                     const EnergyLedger::Alter& alter = {}) {
  World world = can_of_grains(law, time_step);
  EnergyLedger ledger(world, alter);
  const long steps = std::lround(seconds / world.time_step());
  for (long k = 0; k < steps; ++k) ledger.step();
  return ledger.account();
}

void verify_second(const std::string& law_name, const GrainLaw& law) {
  const EnergyAccount a = tumble(law, 1.0, 1e-5);
  const std::string name = "a second in a tumbling can, " + law_name + ", ";
  REQUIRE(a.out() > 0.0);
  REQUIRE(std::abs(a.walls) > 0.01 * a.out());
  verify(name + "work missing / dissipated", 0.0, a.missing_work() / a.out(), absolute(1e-9));
  verify(name + "energy missing / dissipated", 0.0, a.missing() / a.out(), absolute(1e-4));
  CHECK(a.dashpot > 0.0);
  CHECK(a.friction > 0.0);
  CHECK((law.rolling + law.elastic_rolling > 0.0 ? a.couples > 0.0 : a.couples == 0.0));
}

/// A grain that bears its weight on a plane, given a push too small to slide: a double of World
/// whose forces may be altered before they act.
EnergyAccount nudge(const EnergyLedger::Alter& alter) {
  const GrainLaw law{.restitution = 0.5, .sliding = 2.0};
  const ContactModel model(parameters(law));
  const PairLaw& pair = model.law(MaterialId::wall);
  const double dt = 1e-5;
  GrainRow grain = sphere(0.5 * law.diameter, law.density);
  const auto block = std::make_unique<ContactBlock>();
  alignas(64) std::array<double, ContactBlock::width * most_history_columns> history{};
  grain.z = 0.99 * grain.radius;
  const double stiffness = 4.0 / 3.0 * pair.elastic.modulus * std::sqrt(grain.radius);
  const double bearing = stiffness * std::pow(0.01 * grain.radius, 1.5);
  grain.vx = 1e-3;
  EnergyAccount account;
  for (int step = 0; step < 200; ++step) {
    block->i.radius.fill(grain.radius);
    block->i.z.fill(grain.z);
    block->i.inverse_mass.fill(grain.inverse_mass);
    block->i.vx.fill(grain.vx);
    block->i.vz.fill(grain.vz);
    block->i.wy.fill(grain.wy);
    apply(pair, Partner::wall, *block, HistoryBlock(history.data()), dt);
    alter(*block);
    const GrainRow before = grain;
    const double push = dt * block->tangent_x[0];
    grain.vx += grain.inverse_mass * push;
    grain.wy -= grain.inverse_inertia * before.radius * 0.99 * push;
    grain.vz += grain.inverse_mass * dt * (block->normal_force[0] - bearing);
    add_work(*block, 0, mean_motion(before, grain), GrainRow{}, dt, account);
  }
  return account;
}

/// Turns the tangential dashpot's force round.
void reverse_dashpot(ContactBlock& c) {
  for (std::size_t i = 0; i < ContactBlock::width; ++i) {
    c.tangent_x[i] += 2.0 * c.shear_damping[i] * c.slip_x[i];
  }
}

}  // namespace

TEST_CASE("a second of tumbling accounts for its energy", "[engine][verification]") {
  verify_second("elastic rolling resistance",
                {.restitution = 0.6, .sliding = 0.45, .elastic_rolling = 0.05});
}

TEST_CASE("a second of tumbling accounts for its energy under other laws",
          "[engine][verification][slow]") {
  verify_second("friction", {.restitution = 0.6, .sliding = 0.45});
  verify_second("rolling resistance", {.restitution = 0.6, .sliding = 0.45, .rolling = 0.05});
  verify_second("little restitution",
                {.restitution = 0.3, .sliding = 0.45, .elastic_rolling = 0.05});
}

TEST_CASE("the ledger sees an arm, a couple or a force that is not the World's", "[engine]") {
  const GrainLaw law{.restitution = 0.6, .sliding = 0.45, .rolling = 0.05};
  const auto missing = [&law](const EnergyLedger::Alter& alter) {
    const EnergyAccount a = tumble(law, 0.1, 2e-5, alter);
    return std::abs(a.missing_work() / a.out());
  };
  CHECK(missing({}) < 1e-9);
  const auto whole_radius = [](ContactBlock& c) {
    c.arm_i = c.i.radius;
    c.arm_j = c.j.radius;
  };
  CHECK(missing(whole_radius) > 1e-4);
  const auto turned_couple = [](ContactBlock& c) {
    for (double& x : c.couple_y) x = -x;
  };
  CHECK(missing(turned_couple) > 1e-4);
  CHECK(missing(reverse_dashpot) > 1e-4);
}

TEST_CASE("the ledger sees a tangential dashpot that drives instead of braking", "[engine]") {
  const EnergyAccount right = nudge([](ContactBlock&) {});
  const EnergyAccount wrong = nudge(reverse_dashpot);
  CHECK(right.friction > 0.0);
  CHECK(wrong.friction < 0.0);
}
