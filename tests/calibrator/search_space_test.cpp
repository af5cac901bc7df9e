#include "calibrator/search_space.hpp"

#include <catch2/catch.hpp>

using namespace repose;
using calibrator::Calibration;
using calibrator::Scale;
using calibrator::SearchSpace;
using engine::make_key;
using engine::MaterialId;

namespace {

Calibration two_parameters() {
  Calibration c;
  c.fixed.set(make_key("material.density", {MaterialId::grain}), 1228.0);
  c.free.push_back(
      {make_key("sliding_friction.coefficient", {MaterialId::grain, MaterialId::grain}),
       0.1,
       0.9,
       Scale::linear,
       {}});
  c.free.push_back(
      {make_key("material.shear_modulus", {MaterialId::grain}), 1e6, 1e8, Scale::log, {}});
  return c;
}

}  // namespace

TEST_CASE("a linear parameter is halfway in its value, a log one in its logarithm",
          "[calibrator]") {
  const SearchSpace space(two_parameters());
  CHECK(space.value(0, 0.5) == Approx(0.5));
  CHECK(space.value(1, 0.5) == Approx(1e7));
}

TEST_CASE("the ends of the cube are the bounds, bit for bit", "[calibrator]") {
  const SearchSpace space(two_parameters());
  CHECK(space.value(0, 0.0) == 0.1);
  CHECK(space.value(0, 1.0) == 0.9);
  CHECK(space.value(1, 0.0) == 1e6);
  CHECK(space.value(1, 1.0) == 1e8);
  CHECK(space.value(1, 1.0 + 1e-12) == 1e8);
}

TEST_CASE("a point survives the way to a parameter set and back", "[calibrator]") {
  const SearchSpace space(two_parameters());
  const calibrator::UnitPoint point{0.123, 0.877};
  const auto back = space.coordinates(space.at(point));
  // Rounding of exp and log only.
  CHECK(back[0] == Approx(point[0]).epsilon(1e-13));
  CHECK(back[1] == Approx(point[1]).epsilon(1e-13));
}

TEST_CASE("a set holds the fixed, the free and the tied parameters", "[calibrator]") {
  Calibration c = two_parameters();
  const auto wall = make_key("sliding_friction.coefficient", {MaterialId::wall, MaterialId::grain});
  const auto wall_density = make_key("material.density", {MaterialId::wall});
  c.tied.push_back({wall, c.free[0].key, 0.67});
  c.tied.push_back({wall_density, make_key("material.density", {MaterialId::grain}), 2.0});
  const auto set = SearchSpace(c).at(calibrator::UnitPoint{0.5, 0.5});
  CHECK(set.size() == 5);
  CHECK(set.get(wall).value() == Approx(0.67 * 0.5));
  CHECK(set.get(wall_density).value() == 2456.0);
  CHECK(set.get(make_key("material.density", {MaterialId::grain})).value() == 1228.0);
}

TEST_CASE("a constraint is told of free, tied and fixed parameters alike", "[calibrator]") {
  constexpr auto grain = MaterialId::grain;
  Calibration c = two_parameters();
  const auto wall = make_key("sliding_friction.coefficient", {grain, MaterialId::wall});
  const auto rolling = make_key("rolling_resistance.coefficient", {grain, grain});
  c.tied.push_back({wall, c.free[0].key, 0.5});
  c.fixed.set(rolling, 0.2);
  // 2 friction - 2 friction of the wall + rolling <= 0.7, that is friction <= 0.5: u0 <= 0.5.
  c.constraints.push_back({{{c.free[0].key, 2.0}, {wall, -2.0}, {rolling, 1.0}}, 0.7, {}});
  const SearchSpace space(c);
  CHECK(space.allows(std::vector{0.499, 0.1}));
  CHECK_FALSE(space.allows(std::vector{0.501, 0.1}));
  const auto box = space.box();
  REQUIRE(box.excesses.size() == 1);
  // Over its range, 0.8 in the sum of friction's weight 1.
  CHECK(box.excesses[0](std::vector{1.0, 0.0}) == Approx(0.5));
}

TEST_CASE("a prior's misfit is counted in its deviations, in the parameter's value",
          "[calibrator]") {
  Calibration c = two_parameters();
  c.free[0].prior = calibrator::Prior{0.5, 0.1};
  const SearchSpace space(c);
  CHECK(space.prior_misfit(std::vector{0.5, 0.3}) == Approx(0.0).margin(1e-12));
  CHECK(space.prior_misfit(std::vector{0.75, 0.9}) == Approx(4.0));
  CHECK(space.log_prior(std::vector{0.5, 0.9}) - space.log_prior(std::vector{0.75, 0.1}) ==
        Approx(2.0));
}
