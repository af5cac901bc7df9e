#include "engine/effects/grain_shape.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"
#include "engine/filling.hpp"
#include "engine/instrument.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;

namespace {

Trial trial(std::string_view experiment, double members) {
  Trial result{repose::tests::reference_grain(), {std::string(experiment), Fidelity::draft, {}}, 1};
  result.parameters.set({"grain_shape.members", {MaterialId::grain}}, members);
  auto& settings = result.experiment.settings;
  if (experiment == "kettle") {
    settings = {{"diameter", 0.04}, {"height", 0.034}, {"opening", 0.025}};
  }
  if (experiment == "tilting_box") {
    settings = {{"length", 0.08}, {"width", 0.0275}, {"depth", 0.024}};
  }
  return result;
}

const std::vector<Observation>& observations(const Evaluation& evaluation) {
  if (const auto* failure = std::get_if<Failure>(&evaluation.outcome)) FAIL(failure->message);
  return std::get<std::vector<Observation>>(evaluation.outcome);
}

}  // namespace

TEST_CASE("a number of members between two whole ones is rounded", "[engine]") {
  for (const auto& [members, expected] :
       {std::pair{1.0, 1U}, {1.49, 1U}, {1.5, 2U}, {3.2, 3U}, {4.0, 4U}}) {
    CAPTURE(members);
    CHECK(effects::GrainShape::shape({members}).size() == expected);
  }
}

TEST_CASE("grains of one member are spheres, bit for bit", "[engine]") {
  Trial spheres = trial("kettle", 1.0);
  const Evaluation one = evaluate(spheres);
  spheres.parameters.erase({"grain_shape.members", {MaterialId::grain}});
  const Evaluation none = evaluate(spheres);
  CHECK(observations(one)[0].value == observations(none)[0].value);
  CHECK(one.effort.grain_steps == none.effort.grain_steps);
}

TEST_CASE("rain of clumps puts in whole grains of the mean mass, none touching", "[engine]") {
  for (const double members : {2.0, 3.0, 4.0}) {
    CAPTURE(members);
    const Trial t = trial("drop", members);
    const Run run;
    Session session(t, run);
    REQUIRE(session.set_up(
        {.walls = {plane(0.0)}, .period = {}, .low = {-1, -1, -1}, .high = {1, 1, 1}}));
    CHECK(rain(session, {0.0, 0.05, 0.0, 0.05, 0.0, 200, {}}) == 200);
    const World& world = session.world();
    CHECK(world.grain_count() == 200);
    CHECK(world.grains().size() == static_cast<std::size_t>(200 * members));
    CHECK(session.effort().inserted == 200);
    CHECK(session.effort().grains == 200);
    CHECK(mass_where(world, [](const Vec3&) { return true; }) ==
          Approx(200 * session.grain_mass()).epsilon(1e-9));
    session.world().step();
    CHECK(world.contacts() == 0);
    const ClumpBody& first = world.clumps().bodies()[0];
    const ClumpBody& second = world.clumps().bodies()[1];
    CHECK_FALSE(first.orientation == second.orientation);
  }
}

TEST_CASE("a spread of sizes scales whole clumps", "[engine]") {
  Trial t = trial("drop", 2.0);
  t.parameters.set({"size_spread.deviation", {MaterialId::grain}}, 0.2);
  const Run run;
  Session session(t, run);
  REQUIRE(session.set_up(
      {.walls = {plane(0.0)}, .period = {}, .low = {-1, -1, -1}, .high = {1, 1, 1}}));
  rain(session, {0.0, 0.05, 0.0, 0.05, 0.0, 50, {}});
  std::uint64_t index = 0;
  for (const ClumpBody& body : session.world().clumps().bodies()) {
    Random random(t.seed, Purpose::grain_size, index++);
    const double volume = effects::SizeSpread::populate({0.2}, random);
    CHECK(body.mass == Approx(volume * session.grain_mass()).epsilon(1e-9));
  }
}

TEST_CASE("kettle and tilting box run with clumps and count grains", "[engine][slow]") {
  const double members = GENERATE(2.0, 3.0, 4.0);
  CAPTURE(members);
  const Evaluation kettle = evaluate(trial("kettle", members));
  const double density = observations(kettle)[0].value;
  CHECK(density > 0.5 * 1228.0);
  CHECK(density < 0.75 * 1228.0);
  CHECK(kettle.effort.inserted >= kettle.effort.grains);
  CHECK(kettle.effort.requested >= kettle.effort.inserted);
  const Evaluation box = evaluate(trial("tilting_box", members));
  const double angle = observations(box)[0].value;
  CHECK(angle > unit::pi / 180 * 15);
  CHECK(angle < unit::pi / 180 * 60);
  CHECK(box.effort.inserted == box.effort.requested);
}
