#include "engine/boundary.hpp"

#include <cmath>

#include <catch2/catch.hpp>

using namespace repose::engine;

TEST_CASE("the offset from a wall is the shortest way to it", "[engine]") {
  const double s = std::sqrt(0.5);
  struct Case {
    const char* name;
    Surface surface;
    Vec3 centre, offset;
  };
  const Case cases[] = {
      {"above a plane", plane(0.5), {3, 4, 2}, {0, 0, 1.5}},
      {"below a plane", plane(0.5), {3, 4, 0}, {0, 0, -0.5}},
      {"beside an upright", upright(1, 0, 2), {3, 9, 1}, {2, 0, 0}},
      {"over an upright's edge", upright(1, 0, 2), {4, 9, 6}, {3, 0, 4}},
      {"inside a cylinder", cylinder(2, 0, 3), {0, 1.5, 1}, {0, -0.5, 0}},
      {"outside a cylinder", cylinder(2, 0, 3), {3, 0, 1}, {1, 0, 0}},
      {"over a cylinder's rim", cylinder(2, 0, 3), {5, 0, 7}, {3, 0, 4}},
      {"above a disc", disc(2, 1), {1, 1, 3}, {0, 0, 2}},
      {"beside a disc's edge", disc(3, 0), {0, 6, 4}, {0, 3, 4}},
      {"over a disc's hole", disc(3, 0, MaterialId::wall, 1), {0.5, 0, 0}, {-0.5, 0, 0}},
      {"inside a cone", cone(1, 0, 2, 1), {0, 0, 0.0}, {-1, 0, 0}},
      {"inside a drum", lying_cylinder(2, 1, 3), {1, 7, 4.5}, {0, 0, -0.5}},
      {"on a drum's axis", lying_cylinder(2, 1, 3), {1, 7, 3}, {0, 0, 2}},
      {"before the lowest rib", lying_ribs(4, 2, 1, 1, 3)[0], {2, 7, 1.5}, {1, 0, 0}},
      {"over the next rib's edge", lying_ribs(4, 2, 1, 1, 3)[1], {1, 7, 3}, {-1, 0, 0}},
      {"above a rectangle", rectangle({0, 0, 1}, {2, 0, 0}, {0, 1, 0}), {1, 1, 3}, {0, 0, 2}},
      {"beyond a rectangle's corner",
       rectangle({0, 0, 1}, {2, 0, 0}, {0, 1, 0}),
       {5, 5, 1},
       {3, 4, 0}},
      {"above a cone's mantle", cone(0, 0, 2, 2), {0, 0, 1}, {-s * s, 0, s * s}},
  };
  for (const Case& c : cases) {
    CAPTURE(c.name);
    const Vec3 got = offset_from(c.surface, c.centre);
    CHECK(got.x == Approx(c.offset.x).margin(1e-12));
    CHECK(got.y == Approx(c.offset.y).margin(1e-12));
    CHECK(got.z == Approx(c.offset.z).margin(1e-12));
  }
}

TEST_CASE("a far wall loses no digits", "[engine]") {
  CHECK(offset_from(plane(0.0), {40.0, 0.0, 1e-9}).z == 1e-9);
}
