// Walls of triangles against the analytic walls that they stand for.
#include "engine/mesh.hpp"

#include <cmath>
#include <memory>

#include <catch2/catch.hpp>

#include "engine/random.hpp"
#include "engine/world.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;
using repose::tests::GrainLaw;
using repose::tests::parameters;

namespace {

constexpr double radius = 3.248e-3;  // m
constexpr GrainLaw law{.restitution = 0.6, .sliding = 0.45, .elastic_rolling = 0.02};

std::shared_ptr<const Mesh> made(const std::vector<Triangle>& facets) {
  auto mesh = make_mesh(facets, {});
  REQUIRE(mesh);
  return std::make_shared<const Mesh>(*std::move(mesh));
}

/// A level square from 0 to side, of cells whose inner corners are moved at random.
std::vector<Triangle> plate(int cells, double side, double z) {
  Random random(9, Purpose::grain_position);
  const auto n = static_cast<std::size_t>(cells) + 1;
  const double pitch = side / cells;
  std::vector<Vec3> corners;
  corners.reserve(n * n);
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < n; ++i) {
      const bool inner = i > 0 && j > 0 && i + 1 < n && j + 1 < n;
      const double shift_x = inner ? random.uniform(-0.2, 0.2) : 0.0;
      const double shift_y = inner ? random.uniform(-0.2, 0.2) : 0.0;
      corners.push_back({(static_cast<double>(i) + shift_x) * pitch,
                         (static_cast<double>(j) + shift_y) * pitch,
                         z});
    }
  }
  std::vector<Triangle> facets;
  for (std::size_t j = 0; j + 1 < n; ++j) {
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const Vec3 &a = corners[j * n + i], &b = corners[j * n + i + 1];
      const Vec3 &c = corners[(j + 1) * n + i + 1], &d = corners[(j + 1) * n + i];
      if ((i + j) % 2 == 0) {
        facets.insert(facets.end(), {Triangle{a, b, c}, Triangle{a, c, d}});
      } else {
        facets.insert(facets.end(), {Triangle{a, b, d}, Triangle{b, d, c}});
      }
    }
  }
  return facets;
}

/// The mantle of a funnel, opening upwards.
std::vector<Triangle> funnel(int sides, double low_radius, double high_radius, double height) {
  std::vector<Triangle> facets;
  const auto corner = [&](int k, double r, double z) {
    const double angle = 2.0 * unit::pi * k / sides;
    return Vec3{r * std::cos(angle), r * std::sin(angle), z};
  };
  for (int k = 0; k < sides; ++k) {
    const Vec3 a = corner(k, low_radius, 0.0), b = corner(k + 1, low_radius, 0.0);
    const Vec3 c = corner(k + 1, high_radius, height), d = corner(k, high_radius, height);
    facets.push_back({a, b, c});
    facets.push_back({a, c, d});
  }
  return facets;
}

/// The six faces of a box about the origin, two facets each.
std::vector<Triangle> block(double half) {
  std::vector<Triangle> facets;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-half, half}) {
      const auto corner = [&](double u, double v) {
        const std::array<double, 3> c{side, half * u, half * v};
        return Vec3{c[static_cast<std::size_t>((3 - axis) % 3)],
                    c[static_cast<std::size_t>((4 - axis) % 3)],
                    c[static_cast<std::size_t>((5 - axis) % 3)]};
      };
      facets.push_back({corner(-1, -1), corner(1, -1), corner(1, 1)});
      facets.push_back({corner(-1, -1), corner(1, 1), corner(-1, 1)});
    }
  }
  return facets;
}

World thrown(std::vector<Surface> walls, const Vec3& centre, const Vec3& velocity) {
  World world(ContactModel(parameters(law)), {.time_step = 4e-5, .period = {}});
  world.change_surfaces() = std::move(walls);
  GrainRow grain = sphere(radius, 1228.0);
  grain.x = centre.x, grain.y = centre.y, grain.z = centre.z;
  grain.vx = velocity.x, grain.vy = velocity.y, grain.vz = velocity.z;
  world.add(grain);
  return world;
}

/// How far two worlds' only grains get from each other in a second.
double parting(World& a, World& b) {
  double farthest = 0.0;
  for (int step = 0; step < 25000; ++step) {
    a.step();
    b.step();
    farthest = std::max(farthest, norm(a.grains().rows[0].centre() - b.grains().rows[0].centre()));
  }
  return farthest;
}

}  // namespace

TEST_CASE("a grain rolls over a finely split plane as over a plane", "[engine]") {
  constexpr double side = 0.4;
  // The plane is not at zero, where both would be exact for want of digits.
  const auto mesh = made(plate(120, side, 0.0123));
  REQUIRE(mesh->patches() == 1);
  for (const double heading : {0.0, 0.4, unit::pi / 4}) {
    CAPTURE(heading);
    const Vec3 start{0.0511, 0.0523, 0.0123 + radius + 2e-3};
    const Vec3 velocity{0.3 * std::cos(heading), 0.3 * std::sin(heading), 0.0};
    World on_mesh = thrown(mesh_surfaces(mesh), start, velocity);
    World on_plane = thrown({plane(0.0123)}, start, velocity);
    CHECK(parting(on_mesh, on_plane) < 1e-6 * side);
    const Vec3 way = on_mesh.grains().rows[0].centre() - start;
    CHECK(std::hypot(way.x, way.y) > 0.1);
  }
}

TEST_CASE("a tilted and shifted mesh is the mesh, tilted and shifted", "[engine]") {
  const auto mesh = made(plate(8, 0.2, 0.0));
  const double half = 0.15;  // rad, half the tilt
  const Pose pose{{0.1, -0.2, 0.3}, {std::cos(half), std::sin(half), 0.0, 0.0}};
  const auto walls = mesh_surfaces(mesh, MaterialId::wall, pose);
  REQUIRE(walls.size() == 1);
  const Vec3 above = pose.origin + turned(pose.turn, {0.07, 0.08, 0.01});
  const Vec3 offset = offset_from(walls[0], above);
  CHECK(norm(offset - turned(pose.turn, {0.0, 0.0, 0.01})) < 1e-15);
}

TEST_CASE("a mesh funnel is the cone within its chords", "[engine]") {
  const Surface analytic = cone(0.02, 0.0, 0.08, 0.06);
  const auto difference = [&](int sides) {
    const auto mesh = made(funnel(sides, 0.02, 0.08, 0.06));
    REQUIRE(mesh->patches() == 1);
    const Surface walls = mesh_surfaces(mesh)[0];
    const double chord = 0.08 * (1.0 - std::cos(unit::pi / sides));  // m
    Random random(4, Purpose::grain_position);
    for (int k = 0; k < 300; ++k) {
      const Vec3 centre{
          random.uniform(-0.08, 0.08), random.uniform(-0.08, 0.08), random.uniform(0.0, 0.06)};
      CHECK(norm(offset_from(walls, centre)) ==
            Approx(norm(offset_from(analytic, centre))).margin(1.01 * chord));
    }
    // Laid on the mantle, which stands at 45 degrees, and sent along it.
    const double lift = std::sqrt(0.5) * radius;
    const Vec3 start{0.05 - lift, 0.0, 0.03 + lift};
    World in_mesh = thrown({walls}, start, {0.0, 0.5, 0.0});
    World in_cone = thrown({analytic}, start, {0.0, 0.5, 0.0});
    for (int step = 0; step < 2500; ++step) {
      in_mesh.step();
      in_cone.step();
    }
    return norm(in_mesh.grains().rows[0].centre() - in_cone.grains().rows[0].centre());
  };
  const double coarse = difference(360), fine = difference(2880);
  CAPTURE(coarse, fine);
  CHECK(fine < 0.25 * coarse);
  CHECK(fine < 1e-4);
}

TEST_CASE("a grain has one contact with each face that it touches, and one with an edge",
          "[engine]") {
  const auto mesh = made(block(0.05));
  REQUIRE(mesh->patches() == 6);
  CHECK(mesh->parts().boundary_edges == 0);
  const auto walls = mesh_surfaces(mesh);
  const auto touching = [&](const Vec3& centre) {
    int count = 0;
    for (const Surface& wall : walls) {
      count += norm(offset_from(wall, centre, radius)) < radius ? 1 : 0;
    }
    return count;
  };
  const double near = 0.99 * radius;
  CHECK(touching({0.01, 0.02, 0.05 + near}) == 1);                                  // on a face
  CHECK(touching({0.05 + 0.7 * near, 0.0, 0.05 + 0.7 * near}) == 1);                // on an edge
  CHECK(touching({0.05 + 0.5 * near, 0.05 + 0.5 * near, 0.05 + 0.5 * near}) == 1);  // on a corner
  CHECK(touching({0.05 - near, 0.0, 0.0}) == 1);                  // inside, at a face
  CHECK(touching({0.05 - near, 0.05 - near, 0.0}) == 2);          // inside, in an edge
  CHECK(touching({0.05 - near, 0.05 - near, 0.05 - near}) == 3);  // inside, in a corner
}

TEST_CASE("a grain that rolls over a box's edge meets no step", "[engine]") {
  // Over the edge of a box, against the same edge of two rectangles that share it: on the flat the
  // height is that of a plane to the edge itself.
  const auto mesh = made(block(0.05));
  World world = thrown(mesh_surfaces(mesh), {0.0, 0.0, 0.05 + 0.999 * radius}, {0.4, 0.0, 0.0});
  double highest = 0.0;
  for (int step = 0; step < 20000 && world.grains().rows[0].x < 0.0499; ++step) {
    world.step();
    if (step > 5000) highest = std::max(highest, world.grains().rows[0].z);
  }
  CHECK(world.grains().rows[0].x >= 0.0499);
  CHECK(highest < 0.05 + radius);
}

TEST_CASE("a mesh that turns pushes like a wall that turns", "[engine]") {
  const auto paddle = [](std::vector<Surface> walls) {
    World world = thrown(std::move(walls), {0.05, 0.0, 0.02}, {});
    world.change_surfaces().push_back(plane(0.02 - radius));
    world.drive(0, {}, {0.0, 0.0, 3.0});
    for (int step = 0; step < 8000; ++step) world.step();
    return world.grains().rows[0].centre();
  };
  const Vec3 half_a{0.04, 0.0, 0.0}, half_b{0.0, 0.0, 0.02}, centre{0.05, -0.01, 0.02};
  const Vec3 a = centre - half_a - half_b, b = centre + half_a - half_b;
  const Vec3 c = centre + half_a + half_b, d = centre - half_a + half_b;
  const Vec3 by_mesh = paddle(mesh_surfaces(made({{a, b, c}, {a, c, d}})));
  const Vec3 by_rectangle = paddle({rectangle(centre, half_a, half_b)});
  CHECK(norm(by_mesh - by_rectangle) < 1e-6);
  CHECK(std::atan2(by_mesh.y, by_mesh.x) > 0.3);
}
