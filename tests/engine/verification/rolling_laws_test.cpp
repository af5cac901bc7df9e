// The three laws of rolling on the scenes that tell them apart.
#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "tests/engine/verification/table.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;
using namespace repose::tests;

namespace {

constexpr double g = 9.81;
constexpr double mu = 0.02;
constexpr double initial_spin = 60.0;  // rad/s
constexpr double time_step = 1e-5;

enum class Form { relative, elastic, own };
constexpr const char* form_names[] = {"relative", "elastic", "own spin"};

GrainLaw law_of(Form form) {
  GrainLaw law{.restitution = 0.6};
  (form == Form::relative  ? law.rolling
   : form == Form::elastic ? law.elastic_rolling
                           : law.own_spin_rolling) = mu;
  return law;
}

/// Overlap at which Hertz's force bears a load, m.
double bearing(double load, double modulus, double radius) {
  return std::pow(load / (4.0 / 3.0 * modulus * std::sqrt(radius)), 2.0 / 3.0);
}

/// A grain on a plane, or two on top of one another, borne by their overlaps and without friction.
World stack(const GrainLaw& law, int grains) {
  World world(ContactModel(parameters(law)), {.time_step = time_step, .period = {}});
  world.change_surfaces().push_back(plane(0.0));
  GrainRow grain = sphere(0.5 * law.diameter, law.density);
  const double weight = mass(grain) * g;
  const double r = grain.radius;
  grain.z = r - bearing(grains * weight, world.model().law(MaterialId::wall).elastic.modulus, r);
  world.add(grain);
  if (grains == 2) {
    grain.z += 2 * r - bearing(weight, world.model().law(MaterialId::grain).elastic.modulus, r / 2);
    world.add(grain);
  }
  return world;
}

GrainRow grain_of(const World& world, std::uint32_t id) {
  return world.grains().rows[world.grains().ids[0] == id ? 0 : 1];
}

void run(World& world, double seconds) {
  const auto steps = std::lround(seconds / time_step);
  for (long i = 0; i < steps; ++i) world.step();
}

/// Deceleration of two grains that touch without gravity, pressed together by a force: rad/s2.
struct Braked {
  double of_first, of_second;  // change of spin about y
};

Braked press(Form form, double first, double second) {
  const GrainLaw law = law_of(form);
  World world = weightless(law, time_step);
  GrainRow grain = sphere(0.5 * law.diameter, law.density);
  const double r = grain.radius;
  grain.wy = first;
  world.add(grain);
  grain.z = 2 * r * 0.999;
  grain.wy = second;
  world.add(grain);
  world.step();
  return {grain_of(world, 0).wy - first, grain_of(world, 1).wy - second};
}

}  // namespace

TEST_CASE("a grain that spins on a smooth plane is braked by its couple under every law",
          "[engine][verification]") {
  // I dw/dt = -mu_r F R, the same at a wall for all: w = w0 - (5/2) mu_r g t / R.
  for (const Form form : {Form::relative, Form::elastic, Form::own}) {
    World world = stack(law_of(form), 1);
    world.row(0).wy = initial_spin;
    run(world, 0.1);
    const double r = world.grains().rows[0].radius;
    verify(std::string("spin on a plane, rad/s, ") + form_names[static_cast<int>(form)],
           initial_spin - 2.5 * mu * g * 0.1 / r,
           world.grains().rows[0].wy,
           relative(0.01));
  }
}

TEST_CASE("stacked grains of opposite spins brake one another", "[engine][verification]") {
  // The upper grain: dw/dt = (5/2) mu_r g r_cap / R^2, r_cap = R / 2 (reduced) or R (own).
  for (const Form form : {Form::relative, Form::elastic, Form::own}) {
    World world = stack(law_of(form), 2);
    for (std::size_t k = 0; k < 2; ++k)
      world.row(k).wy = world.row(k).z < 5e-3 ? -initial_spin : initial_spin;
    run(world, 0.1);
    const double r = world.grains().rows[0].radius;
    const double share = form == Form::own ? 1.0 : 0.5;
    verify(
        std::string("upper of two of opposite spins, rad/s, ") + form_names[static_cast<int>(form)],
        initial_spin - 2.5 * share * mu * g * 0.1 / r,
        grain_of(world, 1).wy,
        relative(0.01));
  }
}

TEST_CASE("only the own-spin law brakes grains that turn as one", "[engine][verification]") {
  for (const Form form : {Form::relative, Form::elastic, Form::own}) {
    const Braked alike = press(form, initial_spin, initial_spin);
    CAPTURE(form_names[static_cast<int>(form)]);
    CHECK(alike.of_first == alike.of_second);
    CHECK((alike.of_first < 0.0) == (form == Form::own));
    CHECK((alike.of_first == 0.0) == (form != Form::own));
  }
}

TEST_CASE("only the own-spin law leaves a grain at rest alone", "[engine][verification]") {
  const Braked own = press(Form::own, initial_spin, 0.0);
  CHECK(own.of_first < 0.0);
  CHECK(own.of_second == 0.0);
  const Braked relative_law = press(Form::relative, initial_spin, 0.0);
  CHECK(relative_law.of_second == Approx(-relative_law.of_first));
}

TEST_CASE("the own-spin couple is the cap on the arm, of any size of grain",
          "[engine][verification]") {
  const GrainLaw law = law_of(Form::own);
  World world = weightless(law, time_step);
  GrainRow a = sphere(0.5 * law.diameter, law.density);
  GrainRow b = sphere(law.diameter, law.density);
  const double overlap = 1e-3 * a.radius;
  a.wx = initial_spin;
  a.wz = initial_spin;  // twist and roll alike
  b.wy = initial_spin;
  b.z = a.radius + b.radius - overlap;
  world.add(a);
  world.add(b);
  const double reduced = a.radius * b.radius / (a.radius + b.radius);
  const double force = 4.0 / 3.0 * world.model().law(MaterialId::grain).elastic.modulus *
                       std::sqrt(reduced) * std::pow(overlap, 1.5);
  world.step();
  const double change_a = norm(a.spin()) - norm(grain_of(world, 0).spin());
  const double change_b = b.wy - grain_of(world, 1).wy;
  const double arm_a = a.radius - overlap / 2, arm_b = b.radius - overlap / 2;
  verify("own-spin torque on the smaller, N m",
         mu * force * arm_a,
         change_a / a.inverse_inertia / time_step,
         relative(1e-6));
  verify("own-spin torque on the larger, N m",
         mu * force * arm_b,
         change_b / b.inverse_inertia / time_step,
         relative(1e-6));
}
