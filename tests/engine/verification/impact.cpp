#include "tests/engine/verification/impact.hpp"

#include <algorithm>
#include <cmath>

namespace repose::tests {

using namespace engine;

namespace {

const GrainRow& grain_of(const World& world, std::uint32_t id) {
  const Grains& grains = world.grains();
  std::size_t row = 0;
  while (grains.ids[row] != id) ++row;
  return grains.rows[row];
}

World before(const Impact& impact) {
  const GrainLaw& law = impact.law;
  GrainRow a = sphere(0.5 * law.diameter, law.density);
  GrainRow b = sphere(impact.size_ratio * a.radius, impact.density_ratio * law.density);
  ParameterSet set = parameters(law);
  for (const auto& [key, value] : impact.effects) set.set(key, value);
  const ContactModel model(set);
  const double modulus =
      model.law(impact.wall ? MaterialId::wall : MaterialId::grain).elastic.modulus;
  const double mass_of_pair = impact.wall ? mass(a) : 1.0 / (a.inverse_mass + b.inverse_mass);
  const double radius = impact.wall ? a.radius : a.radius * b.radius / (a.radius + b.radius);
  const double whole = impact_time(mass_of_pair, radius, modulus, impact.normal);
  World world(model, {.time_step = whole / impact.steps, .period = {}, .gravity = {}});
  const bool equal = !impact.wall && impact.size_ratio == 1.0;
  constexpr double gap = 1.0 + 1e-9;
  a.z = a.radius * gap;
  a.vz = equal ? -0.5 * impact.normal : -impact.normal;
  a.vx = impact.tangential;
  a.wy = impact.spin;
  world.add(a);
  if (impact.wall) {
    world.change_surfaces().push_back(plane(0.0));
    return world;
  }
  b.z = -b.radius * gap;
  b.vz = equal ? 0.5 * impact.normal : 0.0;
  b.wy = impact.partner_spin;
  world.add(b);
  return world;
}

}  // namespace

Rebound collide(const Impact& impact) {
  World world = before(impact);
  Rebound result;
  const auto partner = [&] { return impact.wall ? GrainRow{} : grain_of(world, 1); };
  double speed = grain_of(world, 0).vz;
  for (int step = 0; step < static_cast<int>(3 * impact.steps); ++step) {
    world.step();
    const GrainRow& a = grain_of(world, 0);
    const GrainRow b = partner();
    const double overlap = a.radius + b.radius - (a.z - b.z);
    result.overlap = std::max(result.overlap, overlap);
    result.force = std::max(result.force, mass(a) * (a.vz - speed) / world.time_step());
    speed = a.vz;
    if (overlap > 0.0) result.duration += world.time_step();
  }
  const GrainRow& a = grain_of(world, 0);
  const GrainRow b = partner();
  result.normal = a.vz - b.vz;
  result.tangential = a.vx;
  result.spin = a.wy;
  result.slip = a.vx - a.radius * a.wy - (b.vx + b.radius * b.wy);
  return result;
}

}  // namespace repose::tests
