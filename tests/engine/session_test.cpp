// A run that goes wrong ends with a name and a time, never with a number.
#include "engine/session.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "engine/random.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;

namespace {

Trial kettle_trial() {
  return {repose::tests::reference_grain(), {"kettle", Fidelity::draft, {}}, 3};
}

constexpr double radius = 3.248e-3;  // m

/// A session over a floor, with these grains.
struct Scene {
  Trial trial = kettle_trial();
  Run run;
  Session session{trial, run};

  explicit Scene(const std::vector<Vec3>& centres, Vec3 velocity = {}, bool closed = false) {
    REQUIRE(session.set_up({.walls = {plane(0.0)},
                            .period = {},
                            .low = {-1, -1, -0.01},
                            .high = {1, 1, 1},
                            .closed = closed}));
    for (const Vec3& centre : centres) {
      GrainRow grain = session.next_grain();
      grain.x = centre.x;
      grain.y = centre.y;
      grain.z = centre.z;
      grain.vx = velocity.x;
      grain.vy = velocity.y;
      grain.vz = velocity.z;
      session.put(grain);
    }
  }
};

}  // namespace

TEST_CASE("grains put into one another end the run by name", "[engine]") {
  Scene scene({{0, 0, 0.1}, {0.2 * radius, 0, 0.1}});
  scene.session.world().row(0).inverse_mass = 1e-9;  // neither gives way
  scene.session.world().row(1).inverse_mass = 1e-9;
  CHECK_FALSE(scene.session.run_for(0.1));
  CHECK(scene.session.failure().kind == FailureKind::unstable);
  CHECK(scene.session.failure().message.find("overlap of 1.8") != std::string::npos);
  CHECK(scene.session.failure().simulated_seconds > 0.0);
}

TEST_CASE("a motion that is no number ends the run by name", "[engine]") {
  Scene scene({{0, 0, 0.1}});
  scene.session.world().row(0).vx = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(scene.session.run_for(0.1));
  CHECK(scene.session.failure().kind == FailureKind::unstable);
  CHECK(scene.session.failure().message.find("no longer a number") != std::string::npos);
}

TEST_CASE("grains that leave the room are counted and gone", "[engine]") {
  Scene scene({{0.9, 0, 0.5}, {0, 0, radius}}, {5.0, 0.0, 0.0});
  CHECK(scene.session.run_for(0.05));
  CHECK(scene.session.left_the_room() == 1);
  CHECK(scene.session.world().grain_count() == 1);
}

TEST_CASE("a grain that leaves a closed room ends the run by name", "[engine]") {
  Scene scene({{0.9, 0, 0.5}, {0, 0, radius}}, {5.0, 0.0, 0.0}, true);
  CHECK_FALSE(scene.session.run_for(0.05));
  CHECK(scene.session.failure().kind == FailureKind::unstable);
  CHECK(scene.session.failure().message == "1 grain(s) went through a wall and were lost");
  CHECK(scene.session.failure().simulated_seconds == Approx(0.02).margin(0.01));
}

TEST_CASE("soft grains that sink in by a sixth on a hard impact are no failure", "[engine]") {
  // A session looks every 64 steps: from one of these heights it sees the grain at its deepest.
  constexpr double speed = 1.7, step = 7.64e-5;
  double deepest = 0.0;
  for (int steps_before = 52; steps_before < 64; ++steps_before) {
    Scene scene({{0, 0, radius + steps_before * speed * step}}, {0.0, 0.0, -speed});
    CHECK(scene.session.run_for(0.02));
    deepest = std::max(deepest, scene.session.effort().largest_overlap);
  }
  CHECK(deepest > 0.12);
  CHECK(deepest < 0.20);
}

TEST_CASE("a bed that never rests is a failure with the time it was given", "[engine]") {
  Scene scene({{0, 0, 0.5}});
  CHECK_FALSE(scene.session.rest(0.1));
  CHECK(scene.session.failure().kind == FailureKind::did_not_rest);
  CHECK(scene.session.failure().simulated_seconds == Approx(0.1).margin(0.01));
}

TEST_CASE("what grains at rest overlap is told apart from what they do on impact", "[engine]") {
  Scene scene({{0, 0, 0.05}});
  REQUIRE(scene.session.rest(5.0));
  const Effort effort = scene.session.effort();
  // Its weight alone: m g = 4/3 E* R^(1/2) d^(3/2), on a wall of the same stuff.
  const auto& elastic = scene.session.world().model().law(MaterialId::wall).elastic;
  const double weight = scene.session.grain_mass() * 9.81;
  const double overlap =
      std::pow(0.75 * weight / (elastic.modulus * std::sqrt(radius)), 2.0 / 3.0) / radius;
  CHECK(effort.overlap_at_rest == Approx(overlap).epsilon(0.02));
  CHECK(effort.largest_overlap > 5.0 * effort.overlap_at_rest);
}

TEST_CASE("an observable that could not be read leaves the others, and none is a failure",
          "[engine]") {
  constexpr std::array observables{ObservableInfo{"rate", unit::one, ""},
                                   ObservableInfo{"angle", unit::degree, ""}};
  const Trial trial = kettle_trial();
  const Run run;
  const Session session(trial, run);
  const Reading why = Unexpected{std::string("no slope stands")};

  const Outcome one = outcome_of(std::vector<Reading>{2.5, why}, observables, session);
  const auto& seen = std::get<std::vector<Observation>>(one);
  REQUIRE(seen.size() == 2);
  CHECK(seen[0].value == 2.5);
  CHECK(seen[0].unread.empty());
  CHECK(std::isnan(seen[1].value));
  CHECK(seen[1].unread == "no slope stands");

  const Outcome none = outcome_of(std::vector<Reading>{why, why}, observables, session);
  CHECK(std::get<Failure>(none).kind == FailureKind::not_observed);
  CHECK(std::get<Failure>(none).message == "no slope stands");
}
