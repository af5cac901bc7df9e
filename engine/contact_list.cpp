#include "engine/contact_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace repose::engine {

namespace {

/// Smallest skin over the radius. A settled bed then lists little more than its contacts.
constexpr double least_skin = 0.03;
/// Largest cells an axis is cut into; beyond it cells grow instead.
constexpr int most_cells = 1024;

/// Cells of one axis that a search visits: consecutive, or wrapped at a periodic side.
struct Span {
  int first[2];
  int last[2];
  int parts;
};

Span around(double low, double high, double origin, double edge, int cells, bool periodic) {
  int a = static_cast<int>(std::floor((low - origin) / edge));
  int b = static_cast<int>(std::floor((high - origin) / edge));
  if (!periodic) return {{std::clamp(a, 0, cells - 1), 0}, {std::clamp(b, 0, cells - 1), 0}, 1};
  if (b - a + 1 >= cells) return {{0, 0}, {cells - 1, 0}, 1};
  a = (a % cells + cells) % cells;
  b = (b % cells + cells) % cells;
  if (a <= b) return {{a, 0}, {b, 0}, 1};
  return {{0, a}, {b, cells - 1}, 2};
}

double wrapped(double d, double period) {
  if (period > 0.0) {
    if (d > 0.5 * period) d -= period;
    if (d < -0.5 * period) d += period;
  }
  return d;
}

/// A coordinate brought into [0, period).
double folded(double x, double period) {
  return period > 0.0 ? x - period * std::floor(x / period) : x;
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
  candidates.history.assign(candidates.size() * columns, 0.0);
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

void ContactList::sort_by_cell(Grains& grains, const Vec3& period) {
  double largest = 0.0;
  Vec3 low{1e300, 1e300, 1e300};
  Vec3 high{-1e300, -1e300, -1e300};
  for (GrainRow& g : grains.rows) {
    g.x = folded(g.x, period.x);
    g.y = folded(g.y, period.y);
    largest = std::max(largest, g.radius);
    low = {std::min(low.x, g.x), std::min(low.y, g.y), std::min(low.z, g.z)};
    high = {std::max(high.x, g.x), std::max(high.y, g.y), std::max(high.z, g.z)};
  }
  if (period.x > 0.0) low.x = 0.0, high.x = period.x;
  if (period.y > 0.0) low.y = 0.0, high.y = period.y;
  // Two slow grains of the largest size are always in neighbouring cells.
  const double edge = 2.0 * largest * (1.0 + 2.0 * least_skin);
  const auto cut = [edge](double length) {
    return std::clamp(static_cast<int>(length / edge), 1, most_cells);
  };
  grid_.low = low;
  grid_.nx = cut(high.x - low.x);
  grid_.ny = cut(high.y - low.y);
  grid_.nz = cut(high.z - low.z);
  grid_.edge = edge;
  const auto cell = [this, &low, &high](const GrainRow& g) {
    const auto place = [](double x, double from, double to, int cells) {
      const double length = to > from ? to - from : 1.0;
      return std::clamp(static_cast<int>((x - from) / length * cells), 0, cells - 1);
    };
    const int x = place(g.x, low.x, high.x, grid_.nx);
    const int y = place(g.y, low.y, high.y, grid_.ny);
    const int z = place(g.z, low.z, high.z, grid_.nz);
    return static_cast<std::uint32_t>((z * grid_.ny + y) * grid_.nx + x);
  };
  const std::size_t n = grains.size();
  const auto cells = static_cast<std::size_t>(grid_.nx) * static_cast<std::size_t>(grid_.ny) *
                     static_cast<std::size_t>(grid_.nz);
  grid_.start.assign(cells + 1, 0);
  cell_of_.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    cell_of_[k] = cell(grains.rows[k]);
    ++grid_.start[cell_of_[k] + 1];
  }
  for (std::size_t c = 0; c < cells; ++c) grid_.start[c + 1] += grid_.start[c];
  std::vector<std::uint32_t> next(grid_.start.begin(), grid_.start.end() - 1);
  std::vector<GrainRow> rows(n);
  std::vector<std::uint32_t> ids(n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint32_t to = next[cell_of_[k]]++;
    rows[to] = grains.rows[k];
    ids[to] = grains.ids[k];
  }
  grains.rows = std::move(rows);
  grains.ids = std::move(ids);
  grid_.high = high;
}

void ContactList::find_pairs(const Grains& grains, const Vec3& period) {
  double largest = 0.0;
  for (const GrainRow& g : grains.rows) largest = std::max(largest, g.radius);
  spots_.resize(grains.size());
  for (std::size_t k = 0; k < grains.size(); ++k) {
    const GrainRow& g = grains.rows[k];
    spots_[k] = {g.x, g.y, g.z, g.radius + skins_[k], skins_[k], grains.ids[k]};
  }
  pairs.i.clear();
  pairs.j.clear();
  const Vec3 edge{(grid_.high.x - grid_.low.x) / grid_.nx,
                  (grid_.high.y - grid_.low.y) / grid_.ny,
                  (grid_.high.z - grid_.low.z) / grid_.nz};
  const auto axis = [](double at, double reach, double low, double width, int cells, bool round) {
    return around(at - reach, at + reach, low, width > 0.0 ? width : 1.0, cells, round);
  };
  for (std::uint32_t a = 0; a < grains.size(); ++a) {
    const Spot g = spots_[a];
    // Of two grains the one with the larger skin finds the other, of equal skins the one before it
    // in the rows. Its reach covers both skins.
    const double reach = g.near + largest + g.skin;
    const Span sx = axis(g.x, reach, grid_.low.x, edge.x, grid_.nx, period.x > 0.0);
    const Span sy = axis(g.y, reach, grid_.low.y, edge.y, grid_.ny, period.y > 0.0);
    const Span sz = axis(g.z, reach, grid_.low.z, edge.z, grid_.nz, false);
    const bool slowest = g.skin == slowest_skin_;
    const auto visit = [&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t b = slowest ? std::max(first, a + 1) : first; b < last; ++b) {
        const Spot& h = spots_[b];
        const double dx = wrapped(g.x - h.x, period.x);
        const double dy = wrapped(g.y - h.y, period.y);
        const double dz = g.z - h.z;
        const double near = g.near + h.near;
        if (dx * dx + dy * dy + dz * dz >= near * near) continue;
        if (h.skin > g.skin || (h.skin == g.skin && b <= a)) continue;
        const bool first_is_a = g.id < h.id;
        pairs.i.push_back(first_is_a ? a : b);
        pairs.j.push_back(first_is_a ? b : a);
      }
    };
    const auto row_of_cells = [this](int y, int z) {
      const auto count = [](int cells) { return static_cast<std::size_t>(cells); };
      return (count(z) * count(grid_.ny) + count(y)) * count(grid_.nx);
    };
    for (int z = sz.first[0]; z <= sz.last[0]; ++z) {
      for (int py = 0; py < sy.parts; ++py) {
        for (int y = sy.first[py]; y <= sy.last[py]; ++y) {
          const std::size_t row = row_of_cells(y, z);
          for (int px = 0; px < sx.parts; ++px) {
            visit(grid_.start[row + static_cast<std::size_t>(sx.first[px])],
                  grid_.start[row + static_cast<std::size_t>(sx.last[px]) + 1]);
          }
        }
      }
    }
  }
}

void ContactList::find_walls(const Grains& grains, std::span<const Surface> surfaces) {
  walls.i.clear();
  walls.j.clear();
  for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
    for (std::uint32_t k = 0; k < grains.size(); ++k) {
      const Vec3 centre = grains.rows[k].centre();
      const Vec3 d = offset_from(surfaces[s], centre);
      const double near = grains.rows[k].radius + skins_[k];
      if (dot(d, d) >= near * near) continue;
      walls.i.push_back(k);
      walls.j.push_back(s);
    }
  }
}

void ContactList::rebuild(Grains& grains,
                          std::span<const Surface> surfaces,
                          const Vec3& period,
                          double horizon) {
  const Memory pair_memory = remember(pairs, grains, Partner::grain);
  const Memory wall_memory = remember(walls, grains, Partner::wall);
  sort_by_cell(grains, period);
  const std::size_t n = grains.size();
  skins_.resize(n);
  anchors_.resize(n);
  double largest = 0.0;
  for (const GrainRow& g : grains.rows) largest = std::max(largest, g.radius);
  slowest_skin_ = least_skin * largest;
  for (std::size_t k = 0; k < n; ++k) {
    const GrainRow& g = grains.rows[k];
    skins_[k] = std::max(slowest_skin_, norm(g.velocity()) * horizon);
    anchors_[k] = {g.x, g.y, g.z, skins_[k] * skins_[k]};
  }
  find_pairs(grains, period);
  recall(pair_memory, pairs, grains, Partner::grain);
  find_walls(grains, surfaces);
  recall(wall_memory, walls, grains, Partner::wall);
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
    c.history.resize(kept * columns);
  };
  follow(pairs, Partner::grain);
  follow(walls, Partner::wall);
  anchors_.clear();
}

bool ContactList::outlived(const Grains& grains) const {
  if (anchors_.size() != grains.size()) return true;
  bool moved = false;
  for (std::size_t k = 0; k < anchors_.size(); ++k) {
    const Anchor& a = anchors_[k];
    const GrainRow& g = grains.rows[k];
    const double dx = g.x - a.x, dy = g.y - a.y, dz = g.z - a.z;
    moved |= dx * dx + dy * dy + dz * dz > a.skin_squared;
  }
  return moved;
}

}  // namespace repose::engine
