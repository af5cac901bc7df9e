#include "engine/grains.hpp"

#include "engine/unit.hpp"

namespace repose::engine {

GrainRow sphere(double radius, double density) {
  const double mass = 4.0 / 3.0 * unit::pi * radius * radius * radius * density;
  GrainRow row;
  row.radius = radius;
  row.inverse_mass = 1.0 / mass;
  row.inverse_inertia = 1.0 / (0.4 * mass * radius * radius);
  return row;
}

}  // namespace repose::engine
