// Mass and inertia of unions of spheres against closed forms, and what is refused.
#include "engine/clump_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <catch2/catch.hpp>

#include "engine/soybean_shapes.hpp"
#include "engine/unit.hpp"

using namespace repose::engine;

namespace {

constexpr double pi = unit::pi;

ClumpShape shape_of(const std::vector<ClumpMember>& members) {
  const auto shape = clump_shape(members);
  if (!shape) FAIL(shape.error());
  return *shape;
}

std::string refusal(const std::vector<ClumpMember>& members) {
  const auto shape = clump_shape(members);
  return shape ? "" : shape.error();
}

std::array<double, 3> sorted(const Vec3& v) {
  std::array result{v.x, v.y, v.z};
  std::ranges::sort(result);
  return result;
}

/// Union of two spheres of radius r with centres 2 a apart: twice the part of a ball beyond the
/// plane t = -a, t along the axis from its centre.
struct Dumbbell {
  double volume, axial, transverse;
};
Dumbbell dumbbell(double r, double a) {
  // Integral of t^n over (-a, r).
  const auto power = [&](int n) { return (std::pow(r, n + 1) - std::pow(-a, n + 1)) / (n + 1); };
  const double r2 = r * r;
  const double volume = 2 * pi * (r2 * power(0) - power(2));
  const double along = 2 * pi *
                       (r2 * (power(2) + 2 * a * power(1) + a * a * power(0)) - power(4) -
                        2 * a * power(3) - a * a * power(2));
  const double across = 0.5 * pi * (r2 * r2 * power(0) - 2 * r2 * power(2) + power(4));
  return {volume, 2 * across, along + across};
}

}  // namespace

TEST_CASE("a clump of one sphere has a sphere's mass and inertia", "[engine]") {
  const double r = 3e-3;
  const ClumpShape shape = shape_of({{{0.2, -0.1, 0.4}, r}});
  CHECK(shape.volume == Approx(4.0 / 3.0 * pi * r * r * r).epsilon(1e-14));
  for (const double moment : sorted(shape.inertia)) {
    CHECK(moment == Approx(0.4 * shape.volume * r * r).epsilon(1e-9));
  }
  CHECK(norm(shape.members[0].centre) < 1e-15);
  CHECK(shape.bounding_radius == Approx(r).epsilon(1e-12));
  CHECK(equivalent_diameter(shape) == Approx(2 * r).epsilon(1e-14));
}

TEST_CASE("spheres that only touch have the sum of their masses and inertias", "[engine]") {
  const double r = 2.0;
  const ClumpShape rod = shape_of({{{0, 0, 0}, r}, {{0, 2 * r, 0}, r}});
  const double one = 4.0 / 3.0 * pi * r * r * r;
  CHECK(rod.volume == Approx(2 * one).epsilon(1e-14));
  const auto moments = sorted(rod.inertia);
  CHECK(moments[0] == Approx(0.8 * one * r * r).epsilon(1e-13));
  CHECK(moments[1] == Approx(2.8 * one * r * r).epsilon(1e-13));
  CHECK(moments[2] == Approx(2.8 * one * r * r).epsilon(1e-13));
  CHECK(norm(rod.members[0].centre) == Approx(r).epsilon(1e-14));

  // Unlike spheres in a row: centre of mass by the lever, parallel axes.
  const ClumpShape uneven = shape_of({{{0, 0, 0}, 2.0}, {{3.0, 0, 0}, 1.0}});
  const double small = 4.0 / 3.0 * pi, reduced = one * small / (one + small);
  CHECK(uneven.members[0].centre.x == Approx(-3.0 * small / (one + small)).epsilon(1e-13));
  CHECK(sorted(uneven.inertia)[2] ==
        Approx(0.4 * one * 4 + 0.4 * small + reduced * 9).epsilon(1e-13));
}

TEST_CASE("two overlapping spheres have the mass and inertia of their union", "[engine]") {
  const double r = 3e-3;
  for (const double share : {0.1, 0.5, 0.9}) {  // half the distance over the radius
    const double a = share * r;
    const Dumbbell exact = dumbbell(r, a);
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{0.6, 0.48, 0.64}}) {
      CAPTURE(share, axis.x, axis.y, axis.z);
      const ClumpShape shape = shape_of({{{}, r}, {(2 * a) * axis, r}});
      CHECK(shape.volume == Approx(exact.volume).epsilon(1e-5));
      auto expected = sorted({exact.axial, exact.transverse, exact.transverse});
      const auto moments = sorted(shape.inertia);
      for (std::size_t k = 0; k < 3; ++k) CHECK(moments[k] == Approx(expected[k]).epsilon(1e-5));
      CHECK(shape.bounding_radius == Approx(r + a).epsilon(1e-5));
    }
  }
}

TEST_CASE("a clump's axes turn its members back to where they were given", "[engine]") {
  const std::vector<ClumpMember> given{
      {{0, 0, 0}, 1.0}, {{0.9, 0.5, 0.1}, 0.8}, {{-0.3, 0.8, 0.9}, 0.7}};
  const ClumpShape shape = shape_of(given);
  const Vec3 first = turned(shape.axes, shape.members[0].centre);
  for (std::size_t k = 1; k < given.size(); ++k) {
    const Vec3 arm = turned(shape.axes, shape.members[k].centre) - first;
    CHECK(norm(arm - given[k].centre) < 1e-12);
  }
}

TEST_CASE("the published soybeans have the published volume", "[engine]") {
  for (std::size_t k = 0; k < soybean_shapes.size(); ++k) {
    CAPTURE(k + 1);
    const auto shape = clump_shape(soybean_shapes[k]);
    REQUIRE(shape);
    CHECK(shape->members.size() == k + 1);
    CHECK(shape->volume == Approx(143.5e-9).epsilon(1e-3));  // printed to four figures
  }
}

TEST_CASE("spheres that are no clump are refused by name", "[engine]") {
  using Catch::Contains;
  const ClumpMember unit_ball{{}, 1.0};
  CHECK_THAT(refusal({}), Contains("needs a member"));
  CHECK_THAT(refusal({unit_ball, {{3.0, 0, 0}, 1.0}}), Contains("member 2 does not touch"));
  CHECK_THAT(refusal({unit_ball, {{0.3, 0, 0}, 0.5}}), Contains("member 2 lies wholly inside"));
  CHECK_THAT(refusal({{{0.3, 0, 0}, 0.5}, unit_ball}), Contains("member 1 lies wholly inside"));
  CHECK_THAT(refusal({unit_ball, unit_ball}), Contains("member 2 lies wholly inside member 1"));
  CHECK_THAT(refusal({unit_ball, {{1, 0, 0}, 0.0}}), Contains("member 2 needs"));
  CHECK_THAT(refusal({unit_ball, {{std::nan(""), 0, 0}, 1.0}}), Contains("member 2 needs"));
  std::vector<ClumpMember> chain;
  chain.reserve(9);
  for (int k = 0; k < 9; ++k) chain.push_back({{1.5 * k, 0, 0}, 1.0});
  CHECK_THAT(refusal(chain), Contains("9 members"));
  chain.pop_back();
  CHECK(refusal(chain).empty());
  // Two pieces that hold together each, but not one another.
  CHECK_THAT(refusal({unit_ball, {{1, 0, 0}, 1.0}, {{9, 0, 0}, 1.0}, {{10, 0, 0}, 1.0}}),
             Contains("member 3 does not touch"));
}
