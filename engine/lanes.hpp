/// Lanes: rows of grains and records of history to the columns of a contact block, and back, four
/// at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "engine/contact_block.hpp"
#include "engine/contact_list.hpp"
#include "engine/grains.hpp"
#include "engine/quad.hpp"

namespace repose::engine {

inline constexpr int lanes_at_once = 4;
static_assert(sizeof(GrainRow) == 12 * sizeof(double) && sizeof(GrainLoad) == 8 * sizeof(double) &&
              ContactBlock::width % lanes_at_once == 0);

/// What stands in the lanes past the last contact: two equal spheres that just touch, at rest.
inline constexpr GrainRow idle_i{.z = 1.0, .radius = 0.5, .inverse_mass = 1.0};
inline constexpr GrainRow idle_j{.radius = 0.5, .inverse_mass = 1.0};

/// Four rows to four lanes of the columns of an end.
[[gnu::always_inline]] inline void to_lanes(const std::array<const GrainRow*, 4>& rows,
                                            ContactBlock::End& end,
                                            int lane) {
  constexpr int width = ContactBlock::width;
  const auto part = [&](const double GrainRow::*first, double* to) {
    Quad a = load_quad(&(rows[0]->*first));
    Quad b = load_quad(&(rows[1]->*first));
    Quad c = load_quad(&(rows[2]->*first));
    Quad d = load_quad(&(rows[3]->*first));
    transpose(a, b, c, d);
    store_quad(to + lane, a);
    store_quad(to + lane + width, b);
    store_quad(to + lane + 2 * width, c);
    store_quad(to + lane + 3 * width, d);
  };
  part(&GrainRow::x, end.x.data());
  part(&GrainRow::vx, end.vx.data());
  part(&GrainRow::wx, end.wx.data());
}

/// Four lanes of a vector, a quad for each.
[[gnu::always_inline]] inline std::array<Quad, 4> from_lanes(const ContactBlock::Vector& vector,
                                                             int lane) {
  std::array<Quad, 4> result{load_quad(vector.x.data() + lane),
                             load_quad(vector.y.data() + lane),
                             load_quad(vector.z.data() + lane),
                             Quad{0.0, 0.0, 0.0, 0.0}};
  transpose(result[0], result[1], result[2], result[3]);
  return result;
}

[[gnu::always_inline]] inline void receive(GrainLoad& load, const Quad& force, const Quad& torque) {
  store_quad(&load.fx, load_quad(&load.fx) + force);
  store_quad(&load.tx, load_quad(&load.tx) + torque);
}

/// The records of up to four candidates to four lanes of the history's columns, three columns at a
/// time. The histories end with room for one number more, which the last record's quad reads.
[[gnu::always_inline]] inline void history_to_lanes(const double* records,
                                                    int columns,
                                                    const std::array<std::uint32_t, 4>& candidates,
                                                    int lane,
                                                    double* to) {
  constexpr int width = ContactBlock::width;
  const auto record = [&](int q) {
    return records + static_cast<std::size_t>(candidates[static_cast<std::size_t>(q)]) *
                         static_cast<std::size_t>(columns);
  };
  int column = 0;
  for (; column + 3 <= columns; column += 3) {
    Quad a = load_quad(record(0) + column);
    Quad b = load_quad(record(1) + column);
    Quad c = load_quad(record(2) + column);
    Quad d = load_quad(record(3) + column);
    transpose(a, b, c, d);
    store_quad(to + column * width + lane, a);
    store_quad(to + (column + 1) * width + lane, b);
    store_quad(to + (column + 2) * width + lane, c);
  }
  for (; column < columns; ++column) {
    for (int q = 0; q < 4; ++q) to[column * width + lane + q] = record(q)[column];
  }
}

/// Fills the lanes past the last contact.
[[gnu::always_inline]] inline void idle_rest(ContactBlock& c, int columns, double* history) {
  constexpr int width = ContactBlock::width;
  if (c.count == width) return;
  const int past = (c.count + lanes_at_once - 1) / lanes_at_once * lanes_at_once;
  for (int lane = past; lane < width; lane += lanes_at_once) {
    to_lanes({&idle_i, &idle_i, &idle_i, &idle_i}, c.i, lane);
    to_lanes({&idle_j, &idle_j, &idle_j, &idle_j}, c.j, lane);
  }
  for (int column = 0; column < columns; ++column) {
    std::fill(history + column * width + c.count, history + (column + 1) * width, 0.0);
  }
}

/// A lane of the history's columns to its candidate's record.
[[gnu::always_inline]] inline void history_from_lane(
    const double* from, int lane, double* records, int columns, std::uint32_t candidate) {
  double* const to =
      records + static_cast<std::size_t>(candidate) * static_cast<std::size_t>(columns);
  for (int column = 0; column < columns; ++column) {
    to[column] = from[column * ContactBlock::width + lane];
  }
}

}  // namespace repose::engine
