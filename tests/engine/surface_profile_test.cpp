#include "engine/surface_profile.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/reference_grain.hpp"

using namespace repose::engine;

namespace {

constexpr double width = 0.04;    // m, of the periodic y
constexpr double radius = 0.003;  // m

/// Grains at those places, in a world that repeats along y.
World bed(const std::vector<Vec3>& centres) {
  World world(ContactModel(repose::tests::reference_grain()),
              {.time_step = 1e-5, .period = {0.0, width, 0.0}});
  for (const Vec3& c : centres) {
    GrainRow grain = sphere(radius, 1228.0);
    grain.x = c.x;
    grain.y = c.y;
    grain.z = c.z;
    world.add(grain);
  }
  return world;
}

/// Grains side by side on a slope along x, z = height + slope x.
std::vector<Vec3> slope_of(double slope, double height) {
  std::vector<Vec3> centres;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 10; ++j) {
      const double x = (i + 0.5) * 0.005;
      centres.push_back({x, (j + 0.5) * width / 10, height + slope * x});
    }
  }
  return centres;
}

}  // namespace

TEST_CASE("a line is laid through points as least squares have it", "[engine]") {
  const std::vector<double> x{0.0, 1.0, 2.0, 3.0};
  const LineFit exact = fit_line(x, std::vector<double>{1.0, 3.0, 5.0, 7.0});
  CHECK(exact.slope == Approx(2.0));
  CHECK(exact.intercept == Approx(1.0));
  // Normal equations by hand: mean x 1.5, mean y 1, sum of products 2, of squares 5.
  const LineFit rough = fit_line(x, std::vector<double>{0.0, 2.0, 0.0, 2.0});
  CHECK(rough.slope == Approx(0.4));
  CHECK(rough.intercept == Approx(0.4));
}

TEST_CASE("the height over one grain is its upper half", "[engine]") {
  const World world = bed({{0.01, 0.02, 0.05}});
  const SurfaceProfile p =
      straight_profile(world, {.from = 0.005, .to = 0.015, .count = 10, .points = 1});
  for (const SurfaceHeight& h : p) {
    CAPTURE(h.place);
    const double off = h.place - 0.01;
    const bool over = std::abs(off) < radius;
    CHECK(h.covered == (over ? 1.0 : 0.0));
    if (over) CHECK(h.height == Approx(0.05 + std::sqrt(radius * radius - off * off)));
  }
}

TEST_CASE("a grain on the face where the scene repeats is met from both sides", "[engine]") {
  const World world = bed({{0.01, 0.0, 0.05}});
  const SurfaceProfile p =
      straight_profile(world, {.from = 0.0099, .to = 0.0101, .count = 1, .points = 4000});
  // It covers its diameter of the width.
  CHECK(p[0].covered == Approx(2.0 * radius / width).epsilon(1e-3));
}

TEST_CASE("of grains above each other the uppermost is the surface", "[engine]") {
  const World world = bed({{0.01, 0.02, 0.05}, {0.01, 0.02, 0.03}, {0.01, 0.02, 0.04}});
  const SurfaceProfile p =
      straight_profile(world, {.from = 0.009, .to = 0.011, .count = 1, .points = 1});
  CHECK(p[0].height == Approx(0.05 + radius));
}

TEST_CASE("grains that are not of the bed do not make its surface", "[engine]") {
  const World world = bed({{0.01, 0.02, 0.05}, {0.01, 0.02, 0.09}});
  const SurfaceProfile p = straight_profile(world,
                                            {.from = 0.009, .to = 0.011, .count = 1, .points = 1},
                                            [](const GrainRow& g) { return g.z < 0.07; });
  CHECK(p[0].height == Approx(0.05 + radius));
}

TEST_CASE("the line through a slope of grains has its slope", "[engine]") {
  for (const double slope : {0.0, 0.4, -0.7}) {
    CAPTURE(slope);
    const World world = bed(slope_of(slope, 0.2));
    const SurfaceProfile p =
        straight_profile(world, {.from = 0.05, .to = 0.15, .count = 200, .points = 100});
    // Discrete beams over round grains: two parts in a thousand.
    CHECK(line_through(p).slope == Approx(slope).margin(2e-3));
  }
}

TEST_CASE("roughness is how far heights are off their line", "[engine]") {
  const double a = 0.002;
  const SurfaceProfile p{
      {0.0, 1.0 + a, 1.0}, {0.1, 1.1 - a, 1.0}, {0.2, 1.2 - a, 1.0}, {0.3, 1.3 + a, 1.0}};
  CHECK(line_through(p).slope == Approx(1.0));
  CHECK(roughness(p, line_through(p)) == Approx(a));
}

TEST_CASE("a cone of grains has its slope all round", "[engine]") {
  std::vector<Vec3> centres;
  for (int i = -200; i <= 200; ++i) {
    for (int j = -200; j <= 200; ++j) {
      const Vec3 c{i * 6e-4, j * 6e-4, 0.0};
      centres.push_back({c.x, c.y, 0.1 - 0.5 * norm(c)});
    }
  }
  // The highest of a sector is at the inner edge of its ring, in all rings alike.
  const SurfaceProfile p =
      ring_profile(bed(centres), {.from = 0.02, .to = 0.1, .count = 10, .points = 12});
  CHECK(line_through(p).slope == Approx(-0.5).margin(3e-3));
  CHECK(p[0].place == Approx(0.024));
  CHECK(p[0].height == Approx(0.1 - 0.5 * 0.02 + radius).margin(5e-4));
  CHECK(p[9].covered == 1.0);
}

TEST_CASE("the slope does not jump when a grain moves by a hair", "[engine]") {
  const auto slope = [](double moved) {
    std::vector<Vec3> centres = slope_of(0.4, 0.2);
    centres[200].x += moved;
    centres[200].z += moved;
    const World world = bed(centres);
    return line_through(
               straight_profile(world, {.from = 0.05, .to = 0.15, .count = 30, .points = 60}))
        .slope;
  };
  const double still = slope(0.0);
  CHECK(std::abs(slope(1e-3) - still) < 1e-3);
  for (const double moved : {1e-5, -1e-5, 1e-6, -1e-6}) {
    CAPTURE(moved);
    CHECK(std::abs(slope(moved) - still) < 1e-4);
  }
}

TEST_CASE("places that are bare at most of their points are left out", "[engine]") {
  const World world = bed({{0.01, 0.004, 0.05},
                           {0.03, 0.004, 0.05},
                           {0.03, 0.012, 0.05},
                           {0.03, 0.020, 0.05},
                           {0.03, 0.028, 0.05}});
  const SurfaceProfile p =
      straight_profile(world, {.from = 0.0, .to = 0.04, .count = 2, .points = 400});
  REQUIRE(p.size() == 2);
  const SurfaceProfile covered = covered_places(p);
  REQUIRE(covered.size() == 1);
  CHECK(covered[0].place == Approx(0.03));
}
