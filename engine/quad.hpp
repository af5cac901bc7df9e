/// Quad: four doubles at once, to turn rows of grains into columns of a block and back. On a
/// machine without such registers the compiler splits it; the bits stay the same.
#pragma once

#include <cstring>

namespace repose::engine {

using Quad [[gnu::vector_size(32)]] = double;

[[gnu::always_inline]] inline Quad load_quad(const double* from) {
  Quad q;
  std::memcpy(&q, from, sizeof q);
  return q;
}

[[gnu::always_inline]] inline void store_quad(double* to, const Quad& q) {
  std::memcpy(to, &q, sizeof q);
}

[[gnu::always_inline]] inline Quad fill_quad(double value) {
  return Quad{value, value, value, value};
}

/// What a comparison of quads gives: all bits of a lane set, or none.
using QuadMask = decltype(Quad{} < Quad{});

/// A comparison's lanes as the lowest bits of a number.
[[gnu::always_inline]] inline unsigned bits_of(const QuadMask& mask) {
  using Bytes [[gnu::vector_size(4)]] = signed char;
  const Bytes bytes = __builtin_convertvector(mask, Bytes);
  unsigned word = 0;
  std::memcpy(&word, &bytes, sizeof word);
  return ((word & 0x08040201U) * 0x01010101U) >> 24U;
}

/// Rows of a four by four square to its columns.
[[gnu::always_inline]] inline void transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
  const Quad ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Quad ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Quad cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Quad cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

}  // namespace repose::engine
