/// Instruments: what experiments measure with.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/world.hpp"

namespace repose::engine {

/// Mass of the grains whose centre meets the condition, kg.
double mass_where(const World& world, const std::function<bool(const Vec3& centre)>& condition);

/// Follows some grains from where they are now.
class Tracer {
 public:
  Tracer(const World& world, const std::function<bool(const Vec3& centre)>& condition);

  struct Motion {
    Vec3 displacement;  ///< mean, m
    Vec3 velocity;      ///< mean, m/s
    std::size_t grains = 0;
  };
  /// Mean motion of those that are still there.
  [[nodiscard]] Motion look(const World& world) const;
  [[nodiscard]] std::size_t size() const { return count_; }

 private:
  std::vector<Vec3> start_;           ///< by id
  std::vector<std::uint8_t> traced_;  ///< by id
  std::size_t count_ = 0;
};

/// Where a quantity that was `before` at `from` and `after` at `to` passed `level`.
double crossing(double from, double to, double before, double after, double level);

}  // namespace repose::engine
