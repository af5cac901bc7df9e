#include "engine/motion.hpp"

#include "engine/any_machine.hpp"
#include "engine/quad.hpp"

namespace repose::engine {

namespace {

/// A row is three quads: centre and radius, velocity and inverse mass, spin and inverse inertia.
/// The fourth lane of what is added to each is zero.
inline void advance_all(Motion& m) {
  const double dt = m.dt;
  const Quad fall{m.gravity.x * dt, m.gravity.y * dt, m.gravity.z * dt, 0.0};
  const Quad step{dt, dt, dt, 0.0};
  const Quad none{0.0, 0.0, 0.0, 0.0};
  bool outlived = false;
  for (std::size_t k = m.first_row; k < m.last_row; ++k) {
    GrainRow& row = m.grains.rows[k];
    GrainLoad& load = m.grains.loads[k];
    const double push = row.inverse_mass * dt, turn = row.inverse_inertia * dt;
    const Quad v = load_quad(&row.vx) + (load_quad(&load.fx) * push + fall);
    const Quad w = load_quad(&row.wx) + load_quad(&load.tx) * turn;
    const Quad x = load_quad(&row.x) + v * step;
    store_quad(&row.vx, v);
    store_quad(&row.wx, w);
    store_quad(&row.x, x);
    store_quad(&load.fx, none);
    store_quad(&load.tx, none);
    const ContactList::Anchor& anchor = m.anchors[k];
    const Quad d = x - load_quad(&anchor.x);
    const Quad squared = d * d;
    outlived |= squared[0] + squared[1] + squared[2] > anchor.skin_squared;
  }
  m.outlived = outlived;
}

}  // namespace

void advance(Motion& motion) { AnyMachine<advance_all>::call(motion); }

}  // namespace repose::engine
