#include "engine/wall_pass.hpp"

#include <algorithm>

#include "engine/any_machine.hpp"
#include "engine/lanes.hpp"

namespace repose::engine {

namespace {

constexpr int width = ContactBlock::width;

/// Contacts with walls of one material that wait until they fill a block.
struct Waiting {
  std::array<std::uint32_t, width> candidates{};
  std::array<GrainRow, width> points{};  ///< of the walls: no size, no give
  int count = 0;
};

/// The opposite of what a grain receives at a point, and the wall's own couple.
inline void receive(WallLoad& load,
                    const Quad& force,
                    const Quad& couple,
                    const GrainRow& point,
                    const Vec3& pivot) {
  const Vec3 on_grain{force[0], force[1], force[2]};
  load.force -= on_grain;
  load.torque += Vec3{couple[0], couple[1], couple[2]} - cross(point.centre() - pivot, on_grain);
}

[[gnu::always_inline]] inline void push_block(WallPass& p, MaterialId material, Waiting& waiting) {
  ContactBlock& c = p.block;
  Candidates& all = p.candidates;
  c.count = waiting.count;
  alignas(64) std::array<double, width * most_history_columns> history;
  for (int lane = 0; lane < c.count; lane += lanes_at_once) {
    std::array<const GrainRow*, 4> i{};
    std::array<const GrainRow*, 4> j{};
    std::array<std::uint32_t, 4> k{};
    for (int q = 0; q < lanes_at_once; ++q) {
      const auto n = static_cast<std::size_t>(q);
      const bool idle = lane + q >= c.count;
      const auto at = static_cast<std::size_t>(idle ? lane : lane + q);
      k[n] = waiting.candidates[at];
      i[n] = idle ? &idle_i : p.rows + all.i[k[n]];
      j[n] = idle ? &idle_j : &waiting.points[at];
    }
    to_lanes(i, c.i, lane);
    to_lanes(j, c.j, lane);
    history_to_lanes(all.history.data(), p.history_columns, k, lane, history.data());
  }
  idle_rest(c, p.history_columns, history.data());
  apply(p.model.law(material), Partner::wall, c, HistoryBlock(history.data()), p.dt);
  for (int lane = 0; lane < c.count; lane += lanes_at_once) {
    const auto force = from_lanes(c.force, lane);
    const auto torque = from_lanes(c.torque_i, lane);
    const auto couple = from_lanes(c.torque_j, lane);
    const int lanes = std::min(lanes_at_once, c.count - lane);
    for (int q = 0; q < lanes; ++q) {
      const auto n = static_cast<std::size_t>(q);
      const auto at = static_cast<std::size_t>(lane + q);
      const std::uint32_t k = waiting.candidates[at];
      const std::uint32_t s = all.j[k];
      receive(p.loads[all.i[k]], force[n], torque[n]);
      receive(p.wall_loads[s], force[n], couple[n], waiting.points[at], p.surfaces[s].pivot);
      all.closed[k] = 1;
      history_from_lane(history.data(), lane + q, all.history.data(), p.history_columns, k);
    }
  }
  waiting.count = 0;
}

inline void push_all(WallPass& p) {
  Candidates& all = p.candidates;
  std::array<Waiting, material_names.size()> waiting;
  for (std::uint32_t k = 0; k < all.size(); ++k) {
    const GrainRow& grain = p.rows[all.i[k]];
    const Surface& surface = p.surfaces[all.j[k]];
    const double far = all.closed[k] != 0 ? grain.radius + p.reach : grain.radius;
    const Vec3 offset = offset_from(surface, grain.centre(), far);
    const double squared = dot(offset, offset);
    if (squared >= far * far || squared <= 0.0) {
      if (all.closed[k] != 0) all.open(k, p.history_columns);
      continue;
    }
    Waiting& own = waiting[static_cast<std::size_t>(surface.material)];
    const auto at = static_cast<std::size_t>(own.count++);
    const Vec3 point = grain.centre() - offset;
    const Vec3 velocity = velocity_at(surface, point);
    own.candidates[at] = k;
    own.points[at] = {.x = point.x,
                      .y = point.y,
                      .z = point.z,
                      .vx = velocity.x,
                      .vy = velocity.y,
                      .vz = velocity.z,
                      .wx = surface.spin.x,
                      .wy = surface.spin.y,
                      .wz = surface.spin.z};
    ++p.closed;
    if (own.count == width) push_block(p, surface.material, own);
  }
  for (std::size_t m = 0; m < waiting.size(); ++m) {
    if (waiting[m].count > 0) push_block(p, static_cast<MaterialId>(m), waiting[m]);
  }
}

}  // namespace

void push_walls(WallPass& pass) { AnyMachine<push_all>::call(pass); }

}  // namespace repose::engine
