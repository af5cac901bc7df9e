#include "engine/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/any_machine.hpp"
#include "engine/quad.hpp"

namespace repose::engine {

namespace {

/// Largest number of cells an axis is cut into; beyond it cells grow instead.
constexpr int most_cells = 1024;

constexpr std::array coordinates{&GrainRow::x, &GrainRow::y, &GrainRow::z};

/// A coordinate brought into [0, period).
double folded(double x, double period) {
  return period > 0.0 ? x - period * std::floor(x / period) : x;
}

}  // namespace

namespace {

/// A whole number within [least, most]; what is no number counts as the least.
int whole_within(double value, double least, double most) {
  if (!(value > least)) return static_cast<int>(least);
  return static_cast<int>(std::min(value, most));
}

}  // namespace

void CellGrid::lay_out(const Grains& grains, const Vec3& period, double edge) {
  const std::array<double, 3> periods{period.x, period.y, period.z};
  std::array<double, 3> lows{}, lengths{};
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    double low = std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::lowest();
    for (const GrainRow& g : grains.rows) {
      low = std::min(low, g.*coordinates[a]);
      high = std::max(high, g.*coordinates[a]);
    }
    if (periods[a] > 0.0) low = 0.0, high = periods[a];
    lows[a] = low;
    lengths[a] = high > low ? high - low : edge;
  }
  // Few grains far apart get larger cells, so that a scene never has many more cells than grains.
  const std::size_t most = 1000 + 8 * grains.size();
  for (std::size_t cells = most + 1; cells > most; edge *= 2.0) {
    cells = 1;
    for (std::size_t a = 0; a < axes_.size(); ++a) {
      const int count = whole_within(lengths[a] / edge, 1.0, most_cells);
      axes_[a] = {lows[a], lengths[a] / count, periods[a], count};
      cells *= static_cast<std::size_t>(count);
    }
  }
  order_ = {0, 1, 2};
  std::ranges::stable_sort(
      order_, [this](std::size_t a, std::size_t b) { return axes_[a].cells < axes_[b].cells; });
}

void CellGrid::sort(Grains& grains, const Vec3& period, double edge) {
  for (GrainRow& g : grains.rows) {
    g.x = folded(g.x, period.x);
    g.y = folded(g.y, period.y);
  }
  lay_out(grains, period, edge);
  const auto cell = [this](const GrainRow& g) {
    std::size_t index = 0;
    for (std::size_t place = 3; place-- > 0;) {
      const Axis& axis = axes_[order_[place]];
      const double at = (g.*coordinates[order_[place]] - axis.low) / axis.width;
      const int c = whole_within(at, 0.0, axis.cells - 1.0);
      index = index * static_cast<std::size_t>(axis.cells) + static_cast<std::size_t>(c);
    }
    return static_cast<std::uint32_t>(index);
  };
  const std::size_t n = grains.size();
  std::size_t cells = 1;
  for (const Axis& axis : axes_) cells *= static_cast<std::size_t>(axis.cells);
  start_.assign(cells + 1, 0);
  cell_of_.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    cell_of_[k] = cell(grains.rows[k]);
    ++start_[cell_of_[k] + 1];
  }
  for (std::size_t c = 0; c < cells; ++c) start_[c + 1] += start_[c];
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  std::vector<GrainRow> rows(n);
  std::vector<std::uint32_t> ids(n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint32_t to = next[cell_of_[k]]++;
    rows[to] = grains.rows[k];
    ids[to] = grains.ids[k];
  }
  grains.rows = std::move(rows);
  grains.ids = std::move(ids);
}

void CellGrid::fill_spots(const Grains& grains, std::span<const double> skins) {
  const std::size_t n = grains.size();
  const std::size_t room = n + 3;
  for (std::size_t place = 0; place < 3; ++place) {
    spots_.at[place].assign(room, 0.0);
    const auto coordinate = coordinates[order_[place]];
    for (std::size_t k = 0; k < n; ++k) spots_.at[place][k] = grains.rows[k].*coordinate;
  }
  spots_.near.assign(room, 0.0);
  spots_.skin.assign(room, 0.0);
  largest_radius_ = 0.0;
  smallest_skin_ = std::numeric_limits<double>::max();
  largest_skin_ = 0.0;
  moved_.clear();
  for (std::size_t k = 0; k < n; ++k) {
    const double radius = grains.rows[k].radius;
    spots_.near[k] = radius + skins[k];
    spots_.skin[k] = skins[k];
    largest_radius_ = std::max(largest_radius_, radius);
    smallest_skin_ = std::min(smallest_skin_, skins[k]);
    largest_skin_ = std::max(largest_skin_, skins[k]);
  }
}

CellGrid::Runs CellGrid::runs(const Axis& axis, double low, double high) const {
  const int last = axis.cells - 1;
  constexpr double far = 1e9;  // cells: beyond that a grain is lost anyhow
  int a = whole_within(std::floor((low - axis.low) / axis.width), -far, far);
  int b = whole_within(std::floor((high - axis.low) / axis.width), -far, far);
  if (axis.period <= 0.0) return {{std::clamp(a, 0, last), 0}, {std::clamp(b, 0, last), 0}, 1};
  if (b - a >= last) return {{0, 0}, {last, 0}, 1};
  a = (a % axis.cells + axis.cells) % axis.cells;
  b = (b % axis.cells + axis.cells) % axis.cells;
  if (a <= b) return {{a, 0}, {b, 0}, 1};
  return {{0, a}, {b, last}, 2};
}

/// The search round one grain. Of two grains the one with the larger skin finds the other, of equal
/// skins the one whose row comes first.
struct CellGrid::Search {
  std::uint32_t row;
  std::array<Quad, 3> at;
  Quad near, skin;
  std::array<Quad, 3> period, half;

  /// Keeps the pairs with rows from `first` to before `last` of those whose skin the grain's
  /// exceeds, or also equals.
  template <bool or_equals>
  [[gnu::always_inline]] void scan(const Spots& spots,
                                   std::uint32_t first,
                                   std::uint32_t last,
                                   std::vector<Pair>& pairs) const {
    const Quad none = fill_quad(0.0);
    for (std::uint32_t b = first; b < last; b += 4) {
      Quad squared = none;
      for (std::size_t place = 3; place-- > 0;) {
        Quad d = at[place] - load_quad(spots.at[place].data() + b);
        d -= d > half[place] ? period[place] : none;
        d += d < -half[place] ? period[place] : none;
        squared += d * d;
      }
      const Quad reach = near + load_quad(spots.near.data() + b);
      const Quad other = load_quad(spots.skin.data() + b);
      auto found = squared < reach * reach;
      found &= or_equals ? other <= skin : other < skin;
      unsigned bits = bits_of(found);
      if (last - b < 4) bits &= (1U << (last - b)) - 1U;
      for (; bits != 0; bits &= bits - 1) {
        pairs.push_back({row, b + static_cast<std::uint32_t>(__builtin_ctz(bits))});
      }
    }
  }
};

/// Shows the rows of every line of cells within reach of a search's grain.
template <class See>
inline void CellGrid::for_lines(const Search& s, double reach, const See& see) const {
  std::array<Runs, 3> r{};
  for (std::size_t place = 0; place < 3; ++place) {
    const double at = spots_.at[place][s.row];
    r[place] = runs(axes_[order_[place]], at - reach, at + reach);
  }
  const auto cells = [this](std::size_t place) {
    return static_cast<std::size_t>(axes_[order_[place]].cells);
  };
  const auto line = [&](std::size_t before) {
    for (int part = 0; part < r[0].count; ++part) {
      const auto n = static_cast<std::size_t>(part);
      see(start_[before + static_cast<std::size_t>(r[0].first[n])],
          start_[before + static_cast<std::size_t>(r[0].last[n]) + 1]);
    }
  };
  for (int slow = 0; slow < r[2].count; ++slow) {
    const auto m = static_cast<std::size_t>(slow);
    for (int z = r[2].first[m]; z <= r[2].last[m]; ++z) {
      for (int middle = 0; middle < r[1].count; ++middle) {
        const auto n = static_cast<std::size_t>(middle);
        for (int y = r[1].first[n]; y <= r[1].last[n]; ++y) {
          line((static_cast<std::size_t>(z) * cells(1) + static_cast<std::size_t>(y)) * cells(0));
        }
      }
    }
  }
}

inline void CellGrid::find_for(Search& s, std::vector<Pair>& found) const {
  const std::uint32_t a = s.row;
  const double skin = spots_.skin[a];
  for (std::size_t place = 0; place < 3; ++place) s.at[place] = fill_quad(spots_.at[place][a]);
  s.near = fill_quad(spots_.near[a]);
  s.skin = fill_quad(skin);
  const bool slowest = skin == smallest_skin_;  // finds no row before its own
  // Its reach covers both skins.
  const double reach = spots_.near[a] + largest_radius_ + skin;
  for_lines(s, reach, [&](std::uint32_t first, std::uint32_t last) {
    if (!slowest && first <= a) s.scan<false>(spots_, first, std::min(last, a), found);
    if (last > a) s.scan<true>(spots_, std::max(first, a + 1), last, found);
  });
}

CellGrid::Search CellGrid::search() const {
  Search s{};
  for (std::size_t place = 0; place < 3; ++place) {
    const double period = axes_[order_[place]].period;
    s.period[place] = fill_quad(period);
    s.half[place] =
        fill_quad(period > 0.0 ? 0.5 * period : std::numeric_limits<double>::infinity());
  }
  return s;
}

inline void CellGrid::find_part(const CellGrid& grid,
                                std::uint32_t first,
                                std::uint32_t last,
                                std::vector<Pair>& found) {
  Search search = grid.search();
  for (std::uint32_t row = first; row < last; ++row) {
    search.row = row;
    grid.find_for(search, found);
  }
}

void CellGrid::move(const Grains& grains, std::uint32_t row, double skin) {
  for (std::size_t place = 0; place < 3; ++place) {
    spots_.at[place][row] = grains.rows[row].*coordinates[order_[place]];
  }
  spots_.near[row] = grains.rows[row].radius + skin;
  spots_.skin[row] = skin;
  largest_skin_ = std::max(largest_skin_, skin);
  moved_.push_back(row);
}

std::span<const CellGrid::Pair> CellGrid::near_pairs_of(std::uint32_t row) {
  Search s = search();
  s.row = row;
  for (std::size_t place = 0; place < 3; ++place) s.at[place] = fill_quad(spots_.at[place][row]);
  s.near = fill_quad(spots_.near[row]);
  s.skin = fill_quad(std::numeric_limits<double>::infinity());  // finds all, whoever is faster
  pairs_.clear();
  const double reach = spots_.near[row] + largest_radius_ + largest_skin_;
  for_lines(s, reach, [&](std::uint32_t first, std::uint32_t last) {
    s.scan<true>(spots_, first, last, pairs_);
  });
  for (const std::uint32_t other : moved_) s.scan<true>(spots_, other, other + 1, pairs_);
  std::erase_if(pairs_, [](const Pair& pair) { return pair.a == pair.b; });
  return pairs_;
}

std::span<const std::vector<CellGrid::Pair>> CellGrid::near_pairs(
    const Grains& grains,
    std::span<const double> skins,
    std::span<const std::uint32_t> part_bounds,
    const Team& team) {
  fill_spots(grains, skins);
  found_.resize(part_bounds.size() - 1);
  share(team, found_.size(), [&](std::size_t part) {
    found_[part].clear();
    AnyMachine<find_part>::call(*this, part_bounds[part], part_bounds[part + 1], found_[part]);
  });
  return found_;
}

}  // namespace repose::engine
