#include "engine/contact_list.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <catch2/catch.hpp>

#include "engine/motion.hpp"
#include "engine/random.hpp"

using namespace repose::engine;

namespace {

Grains scattered(int count, double box, double smallest, std::uint64_t seed) {
  Grains grains;
  Random random(seed, Purpose::grain_position);
  for (int k = 0; k < count; ++k) {
    GrainRow row = sphere(3e-3 * random.uniform(smallest, 1.0), 1000);
    row.x = random.uniform(0.0, box);
    row.y = random.uniform(0.0, box);
    row.z = random.uniform(0.0, box);
    row.vx = random.uniform() < 0.1 ? random.uniform(-2.0, 2.0) : 0.0;
    grains.rows.push_back(row);
    grains.ids.push_back(static_cast<std::uint32_t>(k));
    grains.loads.push_back({});
  }
  return grains;
}

using Names = std::set<std::pair<std::uint32_t, std::uint32_t>>;

/// Every pair that overlaps, by looking at all of them.
Names overlapping(const Grains& grains, const Vec3& period) {
  Names names;
  const auto near = [](double d, double p) { return p > 0.0 ? std::remainder(d, p) : d; };
  for (std::size_t a = 0; a < grains.size(); ++a) {
    for (std::size_t b = a + 1; b < grains.size(); ++b) {
      Vec3 d = grains.rows[a].centre() - grains.rows[b].centre();
      d.x = near(d.x, period.x);
      d.y = near(d.y, period.y);
      if (norm(d) < grains.rows[a].radius + grains.rows[b].radius) {
        names.insert(std::minmax(grains.ids[a], grains.ids[b]));
      }
    }
  }
  return names;
}

Names listed(const ContactList& list, const Grains& grains) {
  Names names;
  for (std::size_t k = 0; k < list.pairs.size(); ++k) {
    const std::uint32_t i = grains.ids[list.pairs.i[k]];
    const std::uint32_t j = grains.ids[list.pairs.j[k]];
    CHECK(i < j);
    CHECK(names.insert({i, j}).second);  // no pair twice
  }
  return names;
}

}  // namespace

TEST_CASE("no touching pair is missing from the list, nor listed twice", "[engine]") {
  for (const double smallest : {1.0, 0.3}) {
    for (const Vec3 period : {Vec3{}, Vec3{0.05, 0.05, 0.0}, Vec3{0.0, 0.05, 0.0}}) {
      CAPTURE(smallest, period.x, period.y);
      Grains grains = scattered(600, 0.05, smallest, 5);
      ContactList list(0);
      list.rebuild(grains, {}, period, 1e-3);
      const Names names = listed(list, grains);
      for (const auto& name : overlapping(grains, period)) CHECK(names.count(name) == 1);
    }
  }
}

TEST_CASE("a few small grains far apart cost no more than they are", "[engine]") {
  Grains grains;
  for (std::uint32_t k = 0; k < 4; ++k) {
    GrainRow row = sphere(1e-5, 1000);
    const double place = k < 2 ? 0.0 : 0.3;  // two pairs that touch
    row.x = place + (k % 2 == 1 ? 1.9e-5 : 0.0);
    row.y = row.z = place;
    grains.rows.push_back(row);
    grains.ids.push_back(k);
  }
  ContactList list(0);
  list.rebuild(grains, {}, {}, 0.0);  // a cell for every grain's size would be 1e9 cells
  CHECK(listed(list, grains) == Names{{0, 1}, {2, 3}});
}

TEST_CASE("the list stays complete until a grain has moved by its skin", "[engine]") {
  Grains grains = scattered(400, 0.04, 0.6, 9);
  ContactList list(0);
  const double dt = 1e-4;
  list.rebuild(grains, {}, {}, 10 * dt);
  Random random(1, Purpose::grain_velocity);
  for (GrainRow& row : grains.rows) {
    row.vy = random.uniform(-0.3, 0.3);
  }
  grains.loads.resize(grains.size());
  Motion motion{
      {}, dt, grains, list.anchors().data(), 0, static_cast<std::uint32_t>(grains.size())};
  int valid = 0;
  while (!motion.outlived) {
    const Names names = listed(list, grains);
    for (const auto& name : overlapping(grains, {})) REQUIRE(names.count(name) == 1);
    advance(motion);
    ++valid;
  }
  CHECK(valid > 1);
}

TEST_CASE("a list that is repaired as grains are kicked stays complete", "[engine]") {
  for (const Vec3 period : {Vec3{}, Vec3{0.04, 0.04, 0.0}}) {
    Grains grains = scattered(400, 0.04, 0.6, 11);
    for (GrainRow& row : grains.rows) row.vx = 0.0;
    const std::vector<Surface> walls{plane(0.02)};
    const double dt = 1e-4, horizon = 10 * dt;
    ContactList list(3);
    list.rebuild(grains, walls, period, horizon);
    Random random(1, Purpose::grain_velocity);
    int repairs = 0;
    for (int step = 0; step < 150; ++step) {
      GrainRow& kicked = grains.rows[static_cast<std::size_t>(random.uniform(0.0, 399.99))];
      kicked.vx = random.uniform(-2.0, 2.0);
      kicked.vz = random.uniform(-2.0, 2.0);
      Motion motion{
          {}, dt, grains, list.anchors().data(), 0, static_cast<std::uint32_t>(grains.size())};
      advance(motion);
      if (motion.outlived) {
        const bool repaired = list.repair(grains, walls, horizon);
        repairs += repaired ? 1 : 0;
        if (!repaired) list.rebuild(grains, walls, period, horizon);
      }
      const Names names = listed(list, grains);
      for (const auto& name : overlapping(grains, period)) REQUIRE(names.count(name) == 1);
      std::set<std::uint32_t> at_wall(list.walls.i.begin(), list.walls.i.end());
      REQUIRE(at_wall.size() == list.walls.size());
      for (std::uint32_t k = 0; k < grains.size(); ++k) {
        const GrainRow& row = grains.rows[k];
        if (std::abs(row.z - 0.02) < row.radius) REQUIRE(at_wall.count(k) == 1);
      }
      REQUIRE(list.pairs.closed.size() == list.pairs.size());
      REQUIRE(list.pairs.history.size() == 3 * list.pairs.size() + 1);
    }
    CHECK(repairs > 20);
  }
}

TEST_CASE("history follows a contact through a rebuild that re-orders the rows", "[engine]") {
  Grains grains = scattered(500, 0.04, 0.8, 3);
  ContactList list(3);
  const std::vector<Surface> walls{plane(0.0)};
  list.rebuild(grains, walls, {}, 1e-3);
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> marked;
  for (std::size_t k = 0; k < list.pairs.size(); ++k) {
    list.pairs.closed[k] = 1;
    const auto name = std::pair{grains.ids[list.pairs.i[k]], grains.ids[list.pairs.j[k]]};
    list.pairs.history[3 * k + 1] = marked[name] = 1.0 + static_cast<double>(k);
  }
  REQUIRE(list.walls.size() > 0);
  for (std::size_t k = 0; k < list.walls.size(); ++k) {
    list.walls.closed[k] = 1;
    list.walls.history[3 * k] = 1000.0 + grains.ids[list.walls.i[k]];
  }
  const std::vector<std::uint32_t> before = grains.ids;
  for (GrainRow& row : grains.rows) row.x = 0.04 - row.x;  // mirrored: same neighbours, other cells
  list.rebuild(grains, walls, {}, 1e-3);
  CHECK(grains.ids != before);
  for (std::size_t k = 0; k < list.pairs.size(); ++k) {
    const auto name = std::pair{grains.ids[list.pairs.i[k]], grains.ids[list.pairs.j[k]]};
    REQUIRE(marked.count(name) == 1);
    CHECK(list.pairs.history[3 * k + 1] == marked[name]);
  }
  for (std::size_t k = 0; k < list.walls.size(); ++k) {
    CHECK(list.walls.history[3 * k] == 1000.0 + grains.ids[list.walls.i[k]]);
  }
}
