#include "engine/filling.hpp"

#include <algorithm>
#include <cmath>

namespace repose::engine {

namespace {

/// Layers a rain may use before it gives up on places that fit.
constexpr int most_layers = 4000;

}  // namespace

std::uint64_t rain(Session& session, const Rain& order) {
  session.request(order.grains);
  // Loose enough to lose the lattice on the way down: columns of near-touching grains settle into
  // an ordered bed that is 3 % too light and rolls on its lowest layer.
  const double pitch = 2.5 * session.largest_radius();
  const auto cells = [pitch](double length) {
    return std::max(1, static_cast<int>(length / pitch));
  };
  const int nx = cells(order.high_x - order.low_x);
  const int ny = cells(order.high_y - order.low_y);
  const Vec3 step{(order.high_x - order.low_x) / nx, (order.high_y - order.low_y) / ny, pitch};
  const double jitter_x = 0.5 * step.x - session.largest_radius();
  const double jitter_y = 0.5 * step.y - session.largest_radius();
  const double jitter_z = 0.5 * step.z - session.largest_radius();
  Random random(session.seed(), Purpose::grain_position);
  std::uint64_t put = 0;
  for (int layer = 0; layer < most_layers && put < order.grains; ++layer) {
    if (order.bottom + (layer + 1) * step.z > order.top) break;
    for (int i = 0; i < nx; ++i) {
      for (int j = 0; j < ny && put < order.grains; ++j) {
        GrainRow grain = session.next_grain();
        grain.x = order.low_x + (i + 0.5) * step.x + random.uniform(-jitter_x, jitter_x);
        grain.y = order.low_y + (j + 0.5) * step.y + random.uniform(-jitter_y, jitter_y);
        grain.z = order.bottom + (layer + 0.5) * step.z + random.uniform(-jitter_z, jitter_z);
        grain.vx = random.uniform(-0.2, 0.2);
        grain.vy = random.uniform(-0.2, 0.2);
        grain.vz = random.uniform(-0.2, 0.2);
        if (order.fits && !order.fits(grain.centre(), grain.radius)) continue;
        session.put(grain);
        ++put;
      }
    }
  }
  return put;
}

bool fill_to(Session& session, Rain order, double volume, double level) {
  constexpr double close_packing = 0.64;
  constexpr double patience = 5.0;  // s
  const double mass = 1.1 * close_packing * volume * session.grain().density;
  order.grains = static_cast<std::uint64_t>(mass / session.grain_mass());
  const std::uint64_t put = rain(session, order);
  if (put < order.grains) {
    return session.fail(FailureKind::did_not_fill,
                        "there was room for " + std::to_string(put) + " grains of " +
                            std::to_string(order.grains) + " asked for");
  }
  if (!session.rest(patience)) return false;
  if (strike_off(session, level) == 0) {
    return session.fail(FailureKind::did_not_fill,
                        "the filling does not reach its level: no grain stands above it");
  }
  return session.rest(patience);
}

Stream::Stream(Session& session, const Order& order)
    : session_(session),
      order_(order),
      random_(session.seed(), Purpose::grain_position),
      start_(session.world().time()) {}

void Stream::feed() {
  constexpr int most_tries = 40;
  World& world = session_.world();
  const auto ordered = static_cast<std::uint64_t>((world.time() - start_) * order_.rate);
  session_.request(ordered - ordered_);
  ordered_ = ordered;
  if (ordered_ == put_) return;
  std::vector<GrainRow> near;
  const double reach = 2.0 * session_.largest_radius();
  for (const GrainRow& g : world.grains().rows) {
    if (g.z > order_.bottom - reach) near.push_back(g);
  }
  while (put_ < ordered_) {
    GrainRow grain = session_.next_grain();
    grain.vz = -order_.speed;
    bool placed = false;
    for (int attempt = 0; attempt < most_tries && !placed; ++attempt) {
      const double rho = (order_.radius - grain.radius) * std::sqrt(random_.uniform());
      const double phi = random_.uniform(0.0, 2.0 * unit::pi);
      grain.x = rho * std::cos(phi);
      grain.y = rho * std::sin(phi);
      grain.z = order_.bottom + random_.uniform(grain.radius, order_.height);
      placed = std::ranges::none_of(near, [&grain](const GrainRow& other) {
        const Vec3 d = grain.centre() - other.centre();
        const double touch = grain.radius + other.radius;
        return dot(d, d) < touch * touch;
      });
    }
    if (!placed) return;
    session_.put(grain);
    near.push_back(grain);
    ++put_;
  }
}

std::size_t strike_off(Session& session, double level) {
  return session.world().remove([level](const GrainRow& g) { return g.z > level; });
}

}  // namespace repose::engine
