#include "engine/pair_pass.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine/any_machine.hpp"
#include "engine/lanes.hpp"

namespace repose::engine {

namespace {

constexpr int width = ContactBlock::width;

/// Contacts that wait until they fill a block.
struct Waiting {
  std::array<std::uint32_t, width + lanes_at_once> candidates{};
  int count = 0;
};

/// Periods and half periods as quads; half is beyond any distance where there is no period.
struct Sides {
  Quad x, y, half_x, half_y;
};

Sides sides_of(const Period& period) {
  const auto half = [](double p) {
    return p > 0.0 ? 0.5 * p : std::numeric_limits<double>::infinity();
  };
  return {fill_quad(period.x),
          fill_quad(period.y),
          fill_quad(half(period.x)),
          fill_quad(half(period.y))};
}

/// Differences of a coordinate to those of the nearest images.
[[gnu::always_inline]] inline void to_nearest(Quad& d, const Quad& period, const Quad& half) {
  const Quad none = fill_quad(0.0);
  d -= d > half ? period : none;
  d += d < -half ? period : none;
}

/// Which of four pairs of rows overlap, as bits.
[[gnu::always_inline]] inline unsigned overlapping(const GrainRow* rows,
                                                   const std::uint32_t* i,
                                                   const std::uint32_t* j,
                                                   const Sides& sides) {
  const Quad sign{1.0, 1.0, 1.0, -1.0};  // differences of the coordinates, sum of the radii
  const auto pair = [&](int q) {
    return load_quad(&rows[i[q]].x) - sign * load_quad(&rows[j[q]].x);
  };
  Quad x = pair(0), y = pair(1), z = pair(2), reach = pair(3);
  transpose(x, y, z, reach);
  to_nearest(x, sides.x, sides.half_x);
  to_nearest(y, sides.y, sides.half_y);
  return bits_of(x * x + y * y + z * z < reach * reach);
}

/// Whether two rows that do not overlap are within reach of one another.
bool within_reach(const PairPass& p, std::uint32_t i, std::uint32_t j) {
  const GrainRow& a = p.rows[i];
  const GrainRow& b = p.rows[j];
  const auto nearest = [](double d, double period) {
    return period > 0.0 ? std::min(std::abs(d), period - std::abs(d)) : d;
  };
  const double x = nearest(a.x - b.x, p.period.x), y = nearest(a.y - b.y, p.period.y);
  const double z = a.z - b.z, far = a.radius + b.radius + p.reach;
  return x * x + y * y + z * z < far * far;
}

/// Gathers four lanes of a block. Lanes from `used` on are idle.
[[gnu::always_inline]] inline void gather(
    PairPass& p, const Waiting& waiting, int lane, int used, int columns, double* history) {
  const Candidates& all = p.candidates;
  std::array<const GrainRow*, 4> i{};
  std::array<const GrainRow*, 4> j{};
  std::array<std::uint32_t, 4> k{};
  for (std::size_t q = 0; q < 4; ++q) {
    const bool idle = static_cast<int>(q) >= used;
    k[q] = waiting.candidates[static_cast<std::size_t>(lane) + (idle ? 0 : q)];
    i[q] = idle ? &idle_i : p.rows + all.i[k[q]];
    j[q] = idle ? &idle_j : p.rows + all.j[k[q]];
  }
  to_lanes(i, p.block.i, lane);
  to_lanes(j, p.block.j, lane);
  history_to_lanes(all.history.data(), columns, k, lane, history);
}

/// Gives four lanes of a block to the grains, as far as they are used.
[[gnu::always_inline]] inline void scatter(
    PairPass& p, const Waiting& waiting, int lane, int used, int columns, const double* history) {
  // Local pointers: a byte that is stored could be any of them.
  const std::uint32_t* const i = p.candidates.i.data();
  const std::uint32_t* const j = p.candidates.j.data();
  std::uint8_t* const closed = p.candidates.closed.data();
  double* const records = p.candidates.history.data();
  GrainLoad* const loads = p.loads;
  const auto force = from_lanes(p.block.force, lane);
  const auto torque_i = from_lanes(p.block.torque_i, lane);
  const auto torque_j = from_lanes(p.block.torque_j, lane);
  for (std::size_t q = 0; q < static_cast<std::size_t>(used); ++q) {
    const std::uint32_t k = waiting.candidates[static_cast<std::size_t>(lane) + q];
    receive(loads[i[k]], force[q], torque_i[q]);
    receive(loads[j[k]], -force[q], torque_j[q]);
    closed[k] = 1;
    history_from_lane(history, lane + static_cast<int>(q), records, columns, k);
  }
}

/// Applies the law to the first contacts that wait, at most a block of them. Numbers that are known
/// when this is compiled make whole quads fast.
[[gnu::always_inline]] inline void push_block(PairPass& p, Waiting& waiting, int columns) {
  ContactBlock& c = p.block;
  c.count = std::min(waiting.count, width);
  const int whole = c.count - c.count % lanes_at_once;
  alignas(64) std::array<double, width * most_history_columns> history;
  for (int lane = 0; lane < whole; lane += lanes_at_once) {
    gather(p, waiting, lane, lanes_at_once, columns, history.data());
  }
  if (whole < c.count) gather(p, waiting, whole, c.count - whole, columns, history.data());
  idle_rest(c, columns, history.data());
  apply(p.law, Partner::grain, c, HistoryBlock(history.data()), p.dt);
  for (int lane = 0; lane < whole; lane += lanes_at_once) {
    scatter(p, waiting, lane, lanes_at_once, columns, history.data());
  }
  if (whole < c.count) scatter(p, waiting, whole, c.count - whole, columns, history.data());
  waiting.count -= c.count;
  std::copy_n(waiting.candidates.begin() + c.count, lanes_at_once, waiting.candidates.begin());
}

/// Those of up to four candidates that were closed and do not touch, as bytes of 1.
[[gnu::always_inline]] inline std::uint32_t opened(const std::uint8_t* closed,
                                                   unsigned touching,
                                                   std::uint32_t count) {
  std::uint32_t were = 0;
  std::memcpy(&were, closed, count);
  return were & ~(touching * 0x00204081U & 0x01010101U);  // bit q of `touching` to byte q
}

/// Tests up to four candidates, from `first` on, and has those wait that touch, or that have
/// touched and are within reach.
[[gnu::always_inline]] inline void visit(PairPass& p,
                                         Waiting& waiting,
                                         const Sides& sides,
                                         const std::uint32_t* i,
                                         const std::uint32_t* j,
                                         std::uint32_t first,
                                         std::uint32_t count) {
  const unsigned all = (1U << count) - 1U;
  unsigned waits = overlapping(p.rows, i, j, sides) & all;
  const std::uint32_t apart = opened(p.candidates.closed.data() + first, waits, count);
  for (std::uint32_t q = 0; q < count; ++q) {
    __builtin_prefetch(p.loads + j[q], 1);
    if (apart == 0 || (apart >> 8U * q & 1U) == 0) continue;
    if (p.reach > 0.0 && within_reach(p, i[q], j[q])) {
      waits |= 1U << q;
    } else {
      p.candidates.open(first + q, p.history_columns);
    }
  }
  // The count stays in a register: in memory each candidate would wait for the one before it.
  int waiting_now = waiting.count;
  for (std::uint32_t q = 0; q < count; ++q) {
    waiting.candidates[static_cast<std::size_t>(waiting_now)] = first + q;
    waiting_now += static_cast<int>(waits >> q & 1U);
  }
  waiting.count = waiting_now;
}

/// How many candidates before their visit rows are asked for.
constexpr std::uint32_t ahead = 32;
/// Candidates whose rows the second cache holds: asking for them would only cost time.
constexpr std::size_t few_candidates = 25000;

/// Asks for the rows of four candidates.
[[gnu::always_inline]] inline void ask_for(const GrainRow* rows,
                                           const std::uint32_t* i,
                                           const std::uint32_t* j) {
  for (int q = 0; q < lanes_at_once; ++q) {
    for (const GrainRow* const row : {rows + i[q], rows + j[q]}) {
      __builtin_prefetch(&row->x);  // a row begins in one line of the cache and ends in the next
      __builtin_prefetch(&row->inverse_inertia);
    }
  }
}

[[gnu::always_inline]] inline void push_with(PairPass& p, int columns) {
  const Candidates& all = p.candidates;
  const Sides sides = sides_of(p.period);
  const auto begin = static_cast<std::uint32_t>(p.first);
  const auto end = static_cast<std::uint32_t>(p.last);
  const std::uint32_t whole = end - (end - begin) % lanes_at_once;
  const bool far = all.size() > few_candidates;
  p.block.period = p.period;
  Waiting waiting;
  for (std::uint32_t first = begin; first < whole; first += lanes_at_once) {
    const std::uint32_t* const i = all.i.data() + first;
    const std::uint32_t* const j = all.j.data() + first;
    if (far && whole - first > ahead) ask_for(p.rows, i + ahead, j + ahead);
    visit(p, waiting, sides, i, j, first, lanes_at_once);
    if (waiting.count < width) continue;
    p.closed += width;
    push_block(p, waiting, columns);
  }
  std::array<std::uint32_t, 4> i{};
  std::array<std::uint32_t, 4> j{};
  std::copy_n(all.i.begin() + whole, end - whole, i.begin());
  std::copy_n(all.j.begin() + whole, end - whole, j.begin());
  if (begin < end) visit(p, waiting, sides, i.data(), j.data(), whole, end - whole);
  while (waiting.count > 0) {
    p.closed += static_cast<std::size_t>(std::min(waiting.count, width));
    push_block(p, waiting, columns);
  }
}

/// Most laws carry three columns of history or six.
inline void push_all(PairPass& p) {
  switch (p.history_columns) {
    case 3:
      return push_with(p, 3);
    case 6:
      return push_with(p, 6);
    default:
      return push_with(p, p.history_columns);
  }
}

}  // namespace

void push_pairs(PairPass& pass) { AnyMachine<push_all>::call(pass); }

}  // namespace repose::engine
