#include "engine/instrument.hpp"

#include <cmath>

namespace repose::engine {

double mass_where(const World& world, const std::function<bool(const Vec3& centre)>& condition) {
  double total = 0.0;
  world.for_each_grain([&](const GrainRow& g, std::uint32_t /*id*/) {
    if (condition(g.centre())) total += mass(g);
  });
  return total;
}

Tracer::Tracer(const World& world, const std::function<bool(const Vec3& centre)>& condition)
    : start_(world.inserted()), traced_(world.inserted(), 0) {
  world.for_each_grain([&](const GrainRow& g, std::uint32_t id) {
    if (!condition(g.centre())) return;
    start_[id] = g.centre();
    traced_[id] = 1;
    ++count_;
  });
}

Tracer::Motion Tracer::look(const World& world) const {
  Motion motion;
  world.for_each_grain([&](const GrainRow& g, std::uint32_t id) {
    if (id >= traced_.size() || traced_[id] == 0) return;
    Vec3 moved = g.centre() - start_[id];
    // Grains are folded into the period as they go: the nearest image is where they came from.
    if (world.period().x > 0.0) moved.x = std::remainder(moved.x, world.period().x);
    if (world.period().y > 0.0) moved.y = std::remainder(moved.y, world.period().y);
    motion.displacement += moved;
    motion.velocity += g.velocity();
    ++motion.grains;
  });
  if (motion.grains == 0) return motion;
  const double share = 1.0 / static_cast<double>(motion.grains);
  motion.displacement = share * motion.displacement;
  motion.velocity = share * motion.velocity;
  return motion;
}

double crossing(double from, double to, double before, double after, double level) {
  return after == before ? to : from + (to - from) * (level - before) / (after - before);
}

}  // namespace repose::engine
