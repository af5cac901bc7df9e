/// Triangle: three corners in space, and the upright boxes about triangles.
#pragma once

#include <algorithm>
#include <array>

#include "engine/vec3.hpp"

namespace repose::engine {

using Triangle = std::array<Vec3, 3>;  ///< m

struct Box {
  Vec3 low, high;  ///< m
};

/// The box about two.
inline Box hull(const Box& a, const Box& b) {
  return {
      {std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
      {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
}

inline Box box_of(const Triangle& t) {
  return hull({t[0], t[0]}, hull({t[1], t[1]}, {t[2], t[2]}));
}

}  // namespace repose::engine
