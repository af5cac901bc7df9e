#include "engine/effects/restitution.hpp"

namespace repose::engine::effects {

namespace {

struct Motion {
  double overlap;
  double speed;  // of approach
};

/// Overlap and time scaled so that the law has no constant but c: x'' = -max(0, x^1.5 + c x^.25
/// x').
Motion change(const Motion& m, double c) {
  const double x = m.overlap > 0.0 ? m.overlap : 0.0;
  const double root = std::sqrt(x);
  const double force = x * root + c * std::sqrt(root) * m.speed;
  return {m.speed, force > 0.0 ? -force : 0.0};
}

Motion along(const Motion& m, const Motion& slope, double dt) {
  return {m.overlap + dt * slope.overlap, m.speed + dt * slope.speed};
}

/// Speed of separation after an approach at unit speed (classical Runge-Kutta).
double rebound(double c) {
  constexpr double dt = 1.0 / 512.0;  // a contact lasts about 3.2: rebound right to 1e-6
  Motion m{0.0, 1.0};
  for (;;) {
    const Motion a = change(m, c);
    const Motion b = change(along(m, a, dt / 2), c);
    const Motion d = change(along(m, b, dt / 2), c);
    const Motion e = change(along(m, d, dt), c);
    m.overlap += dt / 6 * (a.overlap + 2 * b.overlap + 2 * d.overlap + e.overlap);
    m.speed += dt / 6 * (a.speed + 2 * b.speed + 2 * d.speed + e.speed);
    // Once the force has ended while separating it stays ended.
    if (m.speed < 0.0 && (m.overlap <= 0.0 || change(m, c).speed == 0.0)) return -m.speed;
  }
}

}  // namespace

double damping_number(double restitution) {
  if (restitution >= 1.0) return 0.0;
  double low = 0.0;
  double high = 8.0;  // rebounds below 0.03
  for (int i = 0; i < 48; ++i) {
    const double middle = 0.5 * (low + high);
    (rebound(middle) > restitution ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace repose::engine::effects
