#include "engine/effects/sphere_clump.hpp"

#include <string>
#include <vector>

#include "engine/session.hpp"
#include "engine/soybean_shapes.hpp"
#include "tests/support/trials.hpp"

using namespace repose::engine;
using namespace repose::tests;
using Catch::Contains;

namespace {

void set_spheres(ParameterSet& set, std::span<const ClumpMember> members) {
  const auto put = [&](const std::string& name, std::size_t k, double value) {
    set.set({"sphere_clump." + name + "_" + std::to_string(k + 1), {MaterialId::grain}}, value);
  };
  for (std::size_t k = 0; k < members.size(); ++k) {
    put("x", k, members[k].centre.x);
    put("y", k, members[k].centre.y);
    put("z", k, members[k].centre.z);
    put("radius", k, members[k].radius);
  }
}

Trial small_kettle() {
  Trial t = trial_of("kettle");
  t.experiment.settings = {{"diameter", 0.04}, {"height", 0.034}, {"opening", 0.025}};
  return t;
}

Failure refused(std::span<const ClumpMember> members) {
  Trial t = small_kettle();
  set_spheres(t.parameters, members);
  const Evaluation evaluation = evaluate(t);
  CHECK(evaluation.effort.steps == 0);
  CHECK(failure_in(evaluation).kind == FailureKind::bad_input);
  return failure_in(evaluation);
}

}  // namespace

TEST_CASE("a published shape placed by hand is that shape, bit for bit", "[engine]") {
  Trial published = small_kettle();
  published.parameters.set({"grain_shape.members", {MaterialId::grain}}, 2.0);
  Trial placed = small_kettle();
  set_spheres(placed.parameters, soybean::two);
  CHECK(value_in(evaluate(placed), 0) == value_in(evaluate(published), 0));
}

TEST_CASE("one sphere placed by hand is a sphere, bit for bit", "[engine]") {
  Trial placed = small_kettle();
  set_spheres(placed.parameters, std::vector{ClumpMember{{1e-3, 2e-3, 3e-3}, 2e-3}});
  CHECK(value_in(evaluate(placed), 0) == value_in(evaluate(small_kettle()), 0));
}

TEST_CASE("only the ratios of a clump's lengths count: it has the mean grain's mass", "[engine]") {
  const Run run;
  for (const double size : {0.5, 1.0, 3.0}) {
    CAPTURE(size);
    Trial t = trial_of("drop");
    set_spheres(t.parameters,
                std::vector{ClumpMember{{0, 0, 0}, size * 3e-3},
                            ClumpMember{{0, 0, size * 4e-3}, size * 2e-3},
                            ClumpMember{{size * 3e-3, 0, 0}, size * 1e-3}});
    Session session(t, run);
    REQUIRE(session.set_up(
        {.walls = {plane(0.0)}, .period = {}, .low = {-1, -1, -1}, .high = {1, 1, 1}}));
    GrainRow grain = session.next_grain();
    grain.z = 0.1;
    session.put(grain);
    CHECK(session.world().grains().size() == 3);
    CHECK(session.world().clumps().bodies()[0].mass == Approx(session.grain_mass()).epsilon(1e-9));
  }
}

TEST_CASE("a clump with a hole between its spheres is refused with the sphere that is apart",
          "[engine]") {
  const Failure failure = refused(std::vector{ClumpMember{{0, 0, 0}, 2e-3},
                                              ClumpMember{{0, 0, 3e-3}, 2e-3},
                                              ClumpMember{{0, 0, 9e-3}, 2e-3}});
  CHECK_THAT(failure.message, Contains("sphere_clump: member 3 does not touch"));
  CHECK_THAT(refused(std::vector{ClumpMember{{1e-3, 0, 0}, 0.0}}).message,
             Contains("needs a member"));
}

TEST_CASE("grains with two shapes are refused with the effects that give them", "[engine]") {
  Trial t = small_kettle();
  set_spheres(t.parameters, soybean::two);
  t.parameters.set({"grain_shape.members", {MaterialId::grain}}, 3.0);
  CHECK_THAT(failure_in(evaluate(t)).message, Contains("grain_shape and sphere_clump are both on"));
}
