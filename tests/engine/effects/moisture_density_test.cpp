#include "engine/effects/moisture_density.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "engine/amendment.hpp"
#include "engine/evaluate.hpp"
#include "tests/engine/verification/table.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;
using namespace repose::tests;

namespace {

const ParameterKey density{"material.density", {MaterialId::grain}};

ParameterSet swelling(double rate, double reference = 0.12) {
  ParameterSet set = reference_grain();
  set.set({"moisture_density.rate", {MaterialId::grain}}, rate);
  set.set({"moisture_density.reference", {MaterialId::grain}}, reference);
  return set;
}

double reading(const char* experiment, const ParameterSet& set, double moisture) {
  const Evaluation evaluation = evaluate(
      {.parameters = set, .experiment = {experiment, Fidelity::draft, {{"moisture", moisture}}}});
  return std::get<std::vector<Observation>>(evaluation.outcome).front().value;
}

}  // namespace

TEST_CASE("kernels of the published soybean are as light as they were measured", "[engine]") {
  ParameterSet set = swelling(1.7373, 0.0686);
  set.set(density, 1250.0);
  verify("density of soybean at 13.64 %, kg/m3",
         1111.11,
         amended(set, {.moisture = 0.1364}).get(density).value(),
         relative(1e-4));
  CHECK(amended(set, {.moisture = 0.0686}).get(density) == 1250.0);
}

TEST_CASE("a wet kernel rebounds as a dry one of its density does, to the last bit", "[engine]") {
  ParameterSet light = swelling(0.0);
  light.set(density, *light.get(density) * std::exp(-1.5 * (0.2 - 0.12)));
  CHECK(reading("drop", swelling(1.5), 0.2) == reading("drop", light, 0.12));
  CHECK(reading("drop", swelling(0.0), 0.3) == reading("drop", reference_grain(), 0.12));
}

TEST_CASE("a kettle weighs less by as much as its kernels do", "[engine][slow]") {
  // How dense they lie hardly depends on their weight: they are a thousand times as stiff.
  verify("bulk density at 20 % over that at 12 %, 1",
         std::exp(-1.5 * 0.08),
         reading("kettle", swelling(1.5), 0.2) / reading("kettle", swelling(1.5), 0.12),
         relative(0.01));
}
