#include "engine/instrument.hpp"

#include <cmath>

namespace repose::engine {

double mass_where(const World& world, const std::function<bool(const Vec3& centre)>& condition) {
  double total = 0.0;
  for (const GrainRow& g : world.grains().rows) {
    if (condition(g.centre())) total += mass(g);
  }
  return total;
}

Tracer::Tracer(const World& world, const std::function<bool(const Vec3& centre)>& condition)
    : start_(world.inserted()), traced_(world.inserted(), 0) {
  const Grains& grains = world.grains();
  for (std::size_t k = 0; k < grains.size(); ++k) {
    if (!condition(grains.rows[k].centre())) continue;
    start_[grains.ids[k]] = grains.rows[k].centre();
    traced_[grains.ids[k]] = 1;
    ++count_;
  }
}

Tracer::Motion Tracer::look(const World& world) const {
  Motion motion;
  const Grains& grains = world.grains();
  for (std::size_t k = 0; k < grains.size(); ++k) {
    const std::uint32_t id = grains.ids[k];
    if (id >= traced_.size() || traced_[id] == 0) continue;
    Vec3 moved = grains.rows[k].centre() - start_[id];
    // Grains are folded into the period as they go: the nearest image is where they came from.
    if (world.period().x > 0.0) moved.x = std::remainder(moved.x, world.period().x);
    if (world.period().y > 0.0) moved.y = std::remainder(moved.y, world.period().y);
    motion.displacement += moved;
    motion.velocity += grains.rows[k].velocity();
    ++motion.grains;
  }
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
