// Properties that hold for all effects, run over the list.
#include <cmath>
#include <cstring>

#include <catch2/catch.hpp>

#include "engine/amendment.hpp"
#include "engine/catalogue.hpp"
#include "engine/contact_model.hpp"
#include "engine/random.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;

namespace {

/// Every effect of the catalogue switched on well within its bounds, on top of a frictional grain.
ParameterSet with(const EffectInfo& effect, bool on) {
  ParameterSet set = repose::tests::parameters({.restitution = 0.7, .sliding = 0.4});
  for (const FieldInfo& field : effect.fields) {
    const std::string name = std::string(effect.text.name) + "." + std::string(field.name);
    // Not at their middle, where a field that may go either way has its null.
    const double value = on ? std::lerp(field.lower, field.upper, 0.4) : field.null_value;
    for (const MaterialId partner : {MaterialId::grain, MaterialId::wall}) {
      if (effect.scope == Scope::pair) set.set(make_key(name, {MaterialId::grain, partner}), value);
    }
    if (effect.scope == Scope::material) set.set({name, {MaterialId::grain}}, value);
    if (effect.scope == Scope::global) set.set({name, {}}, value);
  }
  return set;
}

ParameterSet without(const EffectInfo& effect) {
  ParameterSet set = with(effect, false);
  for (const FieldInfo& field : effect.fields) {
    const std::string name = std::string(effect.text.name) + "." + std::string(field.name);
    set.erase(make_key(name, {MaterialId::grain, MaterialId::grain}));
    set.erase(make_key(name, {MaterialId::grain, MaterialId::wall}));
    set.erase({name, {MaterialId::grain}});
    set.erase({name, {}});
  }
  return set;
}

/// A few dozen wet grains thrown together in a box that is being filled; returns their final state.
std::vector<GrainRow> tumble(const ParameterSet& set, double time_step = 1e-5, int steps = 4000) {
  const ParameterSet wet = amended(set, {.moisture = 0.2});
  const double density = wet.get({"material.density", {MaterialId::grain}}).value();
  World world(ContactModel(wet), {.time_step = time_step, .period = {0.03, 0.03, 0}});
  world.start_shaking();
  world.change_surfaces().push_back(plane(0.0));
  world.change_surfaces().push_back(plane(0.03));
  Random random(3, Purpose::grain_position);
  for (int k = 0; k < 27; ++k) {
    GrainRow grain = sphere(3e-3 * random.uniform(0.8, 1.0), density);
    grain.x = 0.0075 + 0.0075 * (k % 3);
    const int row = k / 3 % 3;
    const int layer = k / 9;
    grain.y = 0.0075 + 0.0075 * row;
    grain.z = 0.0045 + 0.0075 * layer;
    grain.vx = random.uniform(-1.0, 1.0);
    grain.vy = random.uniform(-1.0, 1.0);
    grain.vz = random.uniform(-1.0, 1.0);
    grain.wx = random.uniform(-50.0, 50.0);
    world.add(grain);
  }
  for (int i = 0; i < steps; ++i) world.step();
  return world.grains().rows;
}

bool same_bits(const std::vector<GrainRow>& a, const std::vector<GrainRow>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(GrainRow)) == 0;
}

/// A block of contacts in random states, with the law of a set applied.
void apply_to_random(const ParameterSet& set, Partner partner, ContactBlock& c) {
  const ContactModel model(set);
  Random random(11, Purpose::grain_velocity);
  for (int lane = 0; lane < ContactBlock::width; ++lane) {
    const auto any = [&random](double size) { return random.uniform(-size, size); };
    const bool grain = partner == Partner::grain;
    const Vec3 n{any(1), any(1), any(1)};
    c.i.radius[lane] = random.uniform(1e-3, 3e-3);
    c.j.radius[lane] = grain ? random.uniform(1e-3, 3e-3) : 0.0;
    const double d = (c.i.radius[lane] + c.j.radius[lane]) * random.uniform(0.9, 0.999) / norm(n);
    c.i.x[lane] = d * n.x;
    c.i.y[lane] = d * n.y;
    c.i.z[lane] = d * n.z;
    c.i.inverse_mass[lane] = random.uniform(1e3, 1e4);
    c.j.inverse_mass[lane] = grain ? random.uniform(1e3, 1e4) : 0.0;
    for (auto* column : {&c.i.vx, &c.i.vy, &c.i.vz}) (*column)[lane] = any(0.5);
    for (auto* column : {&c.i.wx, &c.i.wy, &c.i.wz}) (*column)[lane] = any(50);
    for (auto* column : {&c.j.wx, &c.j.wy, &c.j.wz}) (*column)[lane] = grain ? any(50) : 0.0;
  }
  c.count = ContactBlock::width;
  std::array<double, ContactBlock::width * most_history_columns> history{};
  apply(model.law(partner == Partner::grain ? MaterialId::grain : MaterialId::wall),
        partner,
        c,
        HistoryBlock(history.data()),
        1e-5);
}

}  // namespace

TEST_CASE("at its null values an effect is absent, bit for bit", "[engine]") {
  for (const EffectInfo& effect : effect_catalogue()) {
    CAPTURE(effect.text.name);
    CHECK(same_bits(tumble(with(effect, false)), tumble(without(effect))));
  }
}

TEST_CASE("off its null values an effect changes something", "[engine]") {
  for (const EffectInfo& effect : effect_catalogue()) {
    if (effect.stage == Stage::population) continue;  // acts when grains are made
    CAPTURE(effect.text.name);
    CHECK_FALSE(same_bits(tumble(with(effect, true)), tumble(without(effect))));
  }
}

TEST_CASE("torques about the contact point balance under every law of pairs", "[engine]") {
  for (const EffectInfo& effect : effect_catalogue()) {
    // This law brakes each grain for itself: its file says so.
    if (effect.text.name == "own_spin_rolling_resistance") continue;
    CAPTURE(effect.text.name);
    ContactBlock c{};
    apply_to_random(with(effect, true), Partner::grain, c);
    for (int i = 0; i < ContactBlock::width; ++i) {
      // Angular momentum about centre j: torque i + torque j + (arm_i + arm_j) n x F = 0.
      const Vec3 n{c.normal_x[i], c.normal_y[i], c.normal_z[i]};
      const Vec3 force{c.force.x[i], c.force.y[i], c.force.z[i]};
      const Vec3 sum = Vec3{c.torque_i.x[i] + c.torque_j.x[i],
                            c.torque_i.y[i] + c.torque_j.y[i],
                            c.torque_i.z[i] + c.torque_j.z[i]} +
                       (c.arm_i[i] + c.arm_j[i]) * cross(n, force);
      CHECK(norm(sum) <= 1e-12 * (norm(force) * c.arm_i[i] + 1e-30));
    }
  }
}

TEST_CASE("friction never exceeds its cap, whatever the effect beside it", "[engine]") {
  for (const EffectInfo& effect : effect_catalogue()) {
    if (effect.text.name == "sliding_friction") continue;  // its own coefficient is another
    CAPTURE(effect.text.name);
    for (const Partner partner : {Partner::grain, Partner::wall}) {
      ContactBlock c{};
      apply_to_random(with(effect, true), partner, c);
      for (int i = 0; i < ContactBlock::width; ++i) {
        const double t = norm({c.tangent_x[i], c.tangent_y[i], c.tangent_z[i]});
        CHECK(t <= 0.4 * c.grip_force[i] * (1 + 1e-12));
      }
    }
  }
}

TEST_CASE("a tumbling box gains no energy under any effect", "[engine]") {
  for (const EffectInfo& effect : effect_catalogue()) {
    if (effect.stage == Stage::filling) continue;  // a shaker does work
    CAPTURE(effect.text.name);
    const auto energy = [](const std::vector<GrainRow>& rows) {
      double sum = 0.0;
      for (const GrainRow& row : rows) {
        sum += 0.5 * mass(row) * dot(row.velocity(), row.velocity()) + mass(row) * 9.81 * row.z;
        sum += 0.5 / row.inverse_inertia * dot(row.spin(), row.spin());
      }
      return sum;
    };
    const ParameterSet set = with(effect, true);
    CHECK(energy(tumble(set, 1e-5, 4000)) < energy(tumble(set, 1e-5, 1)));
  }
}

TEST_CASE("every effect is documented and its null lies within its bounds", "[engine]") {
  for (const EffectInfo& effect : effect_catalogue()) {
    CAPTURE(effect.text.name);
    CHECK_FALSE(effect.text.title.empty());
    CHECK_FALSE(effect.text.summary.empty());
    CHECK_FALSE(effect.text.citation.empty());
    REQUIRE_FALSE(effect.fields.empty());
    for (const FieldInfo& field : effect.fields) {
      CAPTURE(field.name);
      CHECK_FALSE(field.meaning.empty());
      CHECK(std::isfinite(field.null_value));
      CHECK(field.lower <= field.null_value);
      CHECK(field.null_value <= field.upper);
    }
  }
}

TEST_CASE("the effects stand in the order of their stages", "[engine]") {
  const auto effects = effect_catalogue();
  for (std::size_t i = 1; i < effects.size(); ++i) CHECK(effects[i - 1].stage <= effects[i].stage);
}
