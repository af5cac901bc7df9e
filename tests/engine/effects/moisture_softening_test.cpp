#include "engine/effects/moisture_softening.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "engine/amendment.hpp"
#include "engine/evaluate.hpp"
#include "tests/engine/verification/table.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;
using namespace repose::tests;

namespace {

constexpr double rate = 15.0;

ParameterSet softening(double of = rate) {
  ParameterSet set = parameters({.restitution = 0.7, .wall_stiffening = 1e3});
  set.set({"moisture_softening.rate", {MaterialId::grain}}, of);
  return set;
}

/// Of a grain that lies on a rigid wall at that moisture, m.
double overlap_at_rest(double moisture) {
  World world(ContactModel(amended(softening(), {.moisture = moisture})),
              {.time_step = 2e-6, .period = {}});
  world.change_surfaces().push_back(plane(0.0));
  GrainRow grain = sphere(3.248e-3, 1228.0);
  grain.z = grain.radius;
  world.add(grain);
  for (int i = 0; i < 60000; ++i) world.step();
  return grain.radius - world.grains().rows[0].z;
}

double rebound(const ParameterSet& set, std::map<std::string, double> settings) {
  const Evaluation evaluation =
      evaluate({.parameters = set, .experiment = {.name = "drop", .settings = settings}});
  return std::get<std::vector<Observation>>(evaluation.outcome).front().value;
}

}  // namespace

TEST_CASE("a wet grain sinks in as Hertz says of its softer modulus", "[engine][verification]") {
  // Hertz: overlap goes with modulus^(-2/3); the wall is a thousand times as stiff as the grain.
  const double dry = overlap_at_rest(0.12);
  verify("overlap at 20 % over that at 12 %, 1",
         std::exp(2.0 / 3.0 * rate * 0.08),
         overlap_at_rest(0.20) / dry,
         relative(0.002));
  verify("overlap at 4 % over that at 12 %, 1",
         std::exp(-2.0 / 3.0 * rate * 0.08),
         overlap_at_rest(0.04) / dry,
         relative(0.002));
}

TEST_CASE("a wet grain rebounds as a dry one of its modulus does, to the last bit", "[engine]") {
  ParameterSet soft = softening(0.0);
  const ParameterKey modulus{"material.shear_modulus", {MaterialId::grain}};
  soft.set(modulus, *soft.get(modulus) * std::exp(-rate * (0.2 - 0.12)));
  CHECK(rebound(softening(), {{"moisture", 0.2}}) == rebound(soft, {}));
}

TEST_CASE("moisture alone, and softening without moisture, change nothing", "[engine]") {
  const double dry = rebound(softening(0.0), {});
  CHECK(rebound(softening(0.0), {{"moisture", 0.3}}) == dry);
  CHECK(rebound(softening(), {}) == dry);
  CHECK(rebound(softening(), {{"moisture", 0.12}}) == dry);
}
