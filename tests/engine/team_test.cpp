// A run that is shared gives the bits of one that is not.

#include <algorithm>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>

#include "engine/random.hpp"
#include "engine/world.hpp"
#include "tests/support/reference_grain.hpp"

namespace repose::engine {

namespace {

/// Parts in the order opposite to the usual one: what depends on the order shows.
void backwards(std::size_t parts, const std::function<void(std::size_t)>& work) {
  for (std::size_t part = parts; part-- > 0;) work(part);
}

/// Every part on a thread of its own, all at once.
void at_once(std::size_t parts, const std::function<void(std::size_t)>& work) {
  std::vector<std::jthread> threads;
  threads.reserve(parts);
  for (std::size_t part = 0; part < parts; ++part) threads.emplace_back([&, part] { work(part); });
}

/// Grains thrown about in a box that repeats along x, dense enough to collide at once.
World crowd(const Team& team) {
  constexpr int across = 26;
  constexpr double pitch = 0.0066;  // m, a little more than a diameter
  World world(ContactModel(repose::tests::reference_grain()),
              {.time_step = 5e-5, .period = {across * pitch, 0.0, 0.0}, .team = team});
  world.change_surfaces() = {plane(0.0), upright(0.0, -1.0, 1.0)};
  Random random(7, Purpose::grain_position);
  for (int k = 0; k < across * across * across; ++k) {
    GrainRow grain = sphere(0.003248, 1228.0);
    const int layer = k / (across * across), line = k / across % across;
    grain.x = (k % across + 0.5) * pitch;
    grain.y = (line + 0.5) * pitch;
    grain.z = (layer + 0.5) * pitch;
    for (double GrainRow::*const v : {&GrainRow::vx, &GrainRow::vy, &GrainRow::vz}) {
      grain.*v = random.uniform(-1.0, 1.0);
    }
    world.add(grain);
  }
  constexpr int steps = 120;
  for (int step = 0; step < steps; ++step) world.step();
  return world;
}

bool same_bits(const World& a, const World& b) {
  if (a.grains().size() != b.grains().size() || a.contacts() != b.contacts()) return false;
  for (std::size_t k = 0; k < a.grains().size(); ++k) {
    const GrainRow& p = a.grains().rows[k];
    const GrainRow& q = b.grains().rows[k];
    if (a.grains().ids[k] != b.grains().ids[k]) return false;
    if (!(p.centre() == q.centre()) || !(p.velocity() == q.velocity()) || !(p.spin() == q.spin())) {
      return false;
    }
  }
  return true;
}

}  // namespace

TEST_CASE("a shared run has the bits of a run alone", "[engine]") {
  const World alone = crowd({});
  REQUIRE(part_bounds(alone.grains().size()).size() > 3);
  REQUIRE(alone.contacts() > 5000);
  REQUIRE(alone.rebuilds() > 2);
  CHECK(same_bits(alone, crowd(backwards)));
  CHECK(same_bits(alone, crowd(at_once)));
}

TEST_CASE("parts follow one another and hold all rows", "[engine]") {
  CHECK(part_bounds(0) == std::vector<std::uint32_t>{0, 0});
  CHECK(part_bounds(8191) == std::vector<std::uint32_t>{0, 8191});
  CHECK(part_bounds(8192) == std::vector<std::uint32_t>{0, 4096, 8192});
  const auto bounds = part_bounds(200000);
  CHECK(bounds.size() == 9);
  CHECK(std::is_sorted(bounds.begin(), bounds.end()));
}

}  // namespace repose::engine
