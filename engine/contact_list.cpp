#include "engine/contact_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "engine/wall_motion.hpp"

namespace repose::engine {

namespace {

/// Smallest skin over the radius. A settled bed then lists little more than its contacts.
constexpr double least_skin = 0.03;
/// The same of a wall that moves: it has few grains near it, and a move of it makes all look again.
constexpr double least_wall_skin = 0.25;
/// Grains looked at again before all are: enough to outlast a stream's impacts, few enough to keep
/// the list short and ordered.
constexpr std::size_t most_repaired = 128;

bool is_near(const Surface& surface, const GrainRow& grain, double skin) {
  return is_within(surface, grain.centre(), grain.radius + skin);
}

}  // namespace

ContactList::Memory ContactList::remember(const Candidates& candidates,
                                          const Grains& grains,
                                          Partner partner) const {
  std::uint32_t ids = 0;
  for (const std::uint32_t id : grains.ids) ids = std::max(ids, id + 1);
  Memory m;
  m.start.assign(ids + 1, 0);
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    if (candidates.closed[k] != 0) ++m.start[grains.ids[candidates.i[k]] + 1];
  }
  for (std::size_t id = 0; id < ids; ++id) m.start[id + 1] += m.start[id];
  const auto columns = static_cast<std::size_t>(history_columns_);
  m.j.resize(m.start[ids]);
  m.history.resize(m.j.size() * columns);
  std::vector<std::uint32_t> next(m.start.begin(), m.start.end() - 1);
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    if (candidates.closed[k] == 0) continue;
    const std::uint32_t slot = next[grains.ids[candidates.i[k]]]++;
    m.j[slot] = partner == Partner::grain ? grains.ids[candidates.j[k]] : candidates.j[k];
    std::copy_n(
        candidates.history.data() + k * columns, columns, m.history.data() + slot * columns);
  }
  return m;
}

void ContactList::recall(const Memory& m,
                         Candidates& candidates,
                         const Grains& grains,
                         Partner partner) const {
  const auto columns = static_cast<std::size_t>(history_columns_);
  candidates.closed.assign(candidates.size(), 0);
  candidates.history.assign(candidates.size() * columns + 1, 0.0);
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const std::uint32_t id = grains.ids[candidates.i[k]];
    const std::uint32_t j =
        partner == Partner::grain ? grains.ids[candidates.j[k]] : candidates.j[k];
    if (id + 1 >= m.start.size()) continue;
    for (std::uint32_t slot = m.start[id]; slot < m.start[id + 1]; ++slot) {
      if (m.j[slot] != j) continue;
      candidates.closed[k] = 1;
      std::copy_n(
          m.history.data() + slot * columns, columns, candidates.history.data() + k * columns);
      break;
    }
  }
}

namespace {

/// Whether two rows are members of one clump.
bool within_body(const Grains& grains,
                 std::span<const std::uint32_t> body_of_id,
                 std::uint32_t a,
                 std::uint32_t b) {
  const std::uint32_t i = grains.ids[a], j = grains.ids[b];
  if (i >= body_of_id.size() || j >= body_of_id.size()) return false;
  return body_of_id[i] != no_body && body_of_id[i] == body_of_id[j];
}

}  // namespace

void ContactList::find_pairs(const Grains& grains,
                             std::span<const std::uint32_t> body_of_id,
                             const Team& team) {
  const std::vector<std::uint32_t> bounds = part_bounds(grains.size());
  const auto found = grid_.near_pairs(grains, skins_, bounds, team);
  pairs.i.clear();
  pairs.j.clear();
  parts_.clear();
  const auto append_pair = [&](std::uint32_t a, std::uint32_t b) {
    const bool first_is_a = grains.ids[a] < grains.ids[b];
    pairs.i.push_back(first_is_a ? a : b);
    pairs.j.push_back(first_is_a ? b : a);
  };
  std::vector<CellGrid::Pair> across;
  for (std::size_t part = 0; part < found.size(); ++part) {
    const std::size_t first = pairs.size();
    for (const auto [a, b] : found[part]) {
      if (!body_of_id.empty() && within_body(grains, body_of_id, a, b)) continue;
      if (b < bounds[part] || b >= bounds[part + 1]) {
        across.push_back({a, b});
      } else {
        append_pair(a, b);
      }
    }
    parts_.push_back({bounds[part], bounds[part + 1], first, pairs.size()});
  }
  for (const auto [a, b] : across) append_pair(a, b);
}

void ContactList::find_walls(const Grains& grains, std::span<const Surface> surfaces) {
  walls.i.clear();
  walls.j.clear();
  for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
    for (std::uint32_t k = 0; k < grains.size(); ++k) {
      if (!is_near(surfaces[s], grains.rows[k], skins_[k] + wall_skins_[s])) continue;
      walls.i.push_back(k);
      walls.j.push_back(s);
    }
  }
}

void ContactList::rebuild(Grains& grains,
                          std::span<const Surface> surfaces,
                          const Vec3& period,
                          double horizon,
                          std::span<const std::uint32_t> body_of_id,
                          const Team& team,
                          double reach) {
  const Memory pair_memory = remember(pairs, grains, Partner::grain);
  const Memory wall_memory = remember(walls, grains, Partner::wall);
  double largest = 0.0;
  for (const GrainRow& g : grains.rows) largest = std::max(largest, g.radius);
  slowest_skin_ = least_skin * largest + reach;
  // Two slow grains of the largest size are always in neighbouring cells.
  grid_.sort(grains, period, 2.0 * (largest + 2.0 * slowest_skin_));
  const std::size_t n = grains.size();
  skins_.resize(n);
  anchors_.resize(n);
  repaired_ = 0;
  for (std::size_t k = 0; k < n; ++k) anchor(grains.rows[k], k, horizon);
  find_pairs(grains, body_of_id, team);
  recall(pair_memory, pairs, grains, Partner::grain);
  wall_skins_.clear();
  wall_skins_.reserve(surfaces.size());
  for (const Surface& surface : surfaces) {
    const double speed = fastest(surface);
    wall_skins_.push_back(speed > 0.0 ? std::max(least_wall_skin * largest, speed * horizon) : 0.0);
  }
  find_walls(grains, surfaces);
  recall(wall_memory, walls, grains, Partner::wall);
}

void ContactList::anchor(const GrainRow& grain, std::size_t row, double horizon) {
  skins_[row] = std::max(slowest_skin_, norm(grain.velocity()) * horizon);
  anchors_[row] = {grain.x, grain.y, grain.z, skins_[row] * skins_[row]};
}

namespace {

/// A pair of rows, or a row and a surface, as one number that sorts.
std::uint64_t key(std::uint32_t i, std::uint32_t j) { return std::uint64_t{i} << 32U | j; }

/// The candidates that have an end among the rows marked.
std::vector<std::uint64_t> keys_of(const Candidates& candidates,
                                   const std::vector<std::uint8_t>& marked,
                                   Partner partner) {
  std::vector<std::uint64_t> result;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const std::uint32_t i = candidates.i[k], j = candidates.j[k];
    const unsigned other = partner == Partner::grain ? marked[j] : 0U;
    if ((marked[i] | other) != 0) result.push_back(key(i, j));
  }
  return result;
}

}  // namespace

void ContactList::append(Candidates& c, const std::vector<std::uint64_t>& found) {
  for (const std::uint64_t each : found) {
    c.i.push_back(static_cast<std::uint32_t>(each >> 32U));
    c.j.push_back(static_cast<std::uint32_t>(each));
  }
  c.closed.resize(c.size(), 0);
  c.history.resize(c.size() * static_cast<std::size_t>(history_columns_) + 1, 0.0);
}

bool ContactList::repair(const Grains& grains,
                         std::span<const Surface> surfaces,
                         double horizon,
                         std::span<const std::uint32_t> body_of_id) {
  const auto n = static_cast<std::uint32_t>(grains.size());
  std::vector<std::uint32_t> escaped;
  for (std::uint32_t k = 0; k < n; ++k) {
    const Anchor& a = anchors_[k];
    const Vec3 d = grains.rows[k].centre() - Vec3{a.x, a.y, a.z};
    if (dot(d, d) > a.skin_squared) escaped.push_back(k);
  }
  repaired_ += escaped.size();
  if (repaired_ > most_repaired) return false;
  std::vector<std::uint8_t> marked(n, 0);
  for (const std::uint32_t k : escaped) {
    marked[k] = 1;
    anchor(grains.rows[k], k, horizon);
    grid_.move(grains, k, skins_[k]);
  }
  std::vector<std::uint64_t> near, near_walls;
  for (const std::uint32_t k : escaped) {
    for (const auto [a, b] : grid_.near_pairs_of(k)) {
      if (within_body(grains, body_of_id, a, b)) continue;
      near.push_back(grains.ids[a] < grains.ids[b] ? key(a, b) : key(b, a));
    }
    for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
      if (is_near(surfaces[s], grains.rows[k], skins_[k] + wall_skins_[s]))
        near_walls.push_back(key(k, s));
    }
  }
  const auto add_new = [&](std::vector<std::uint64_t>& found, Candidates& list, Partner partner) {
    std::vector<std::uint64_t> known = keys_of(list, marked, partner);
    std::ranges::sort(known);
    std::ranges::sort(found);
    found.erase(std::unique(found.begin(), found.end()), found.end());
    std::vector<std::uint64_t> fresh;
    std::ranges::set_difference(found, known, std::back_inserter(fresh));
    append(list, fresh);
  };
  add_new(near, pairs, Partner::grain);
  add_new(near_walls, walls, Partner::wall);
  return true;
}

bool ContactList::outlived(const Grains& grains, std::span<const std::uint32_t> rows) const {
  return std::ranges::any_of(rows, [&](std::uint32_t k) {
    const Anchor& a = anchors_[k];
    const Vec3 moved = grains.rows[k].centre() - Vec3{a.x, a.y, a.z};
    return dot(moved, moved) > a.skin_squared;
  });
}

void ContactList::renumber(const std::vector<std::uint32_t>& new_row, std::uint32_t gone) {
  const auto columns = static_cast<std::size_t>(history_columns_);
  const auto follow = [&](Candidates& c, Partner partner) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < c.size(); ++k) {
      const std::uint32_t i = new_row[c.i[k]];
      const std::uint32_t j = partner == Partner::grain ? new_row[c.j[k]] : c.j[k];
      if (i == gone || (partner == Partner::grain && j == gone)) continue;
      c.i[kept] = i;
      c.j[kept] = j;
      c.closed[kept] = c.closed[k];
      std::copy_n(c.history.data() + k * columns, columns, c.history.data() + kept * columns);
      ++kept;
    }
    c.i.resize(kept);
    c.j.resize(kept);
    c.closed.resize(kept);
    c.history.resize(kept * columns + 1);
  };
  follow(pairs, Partner::grain);
  follow(walls, Partner::wall);
}

}  // namespace repose::engine
