/// Heap: a cylinder full of grains is lifted off a disc; what stays is a heap on a constant base.
///
/// Protocol: a cylinder stands in the middle of a disc that is covered with grains' stuff and has a
/// low rim of the same. Grains rain into it, come to rest and are struck off at `fill`. The
/// cylinder is lifted at `lift_speed` until its lower edge is above all grains, or at twice `fill`:
/// the few that still hang in it then are carried off with it. What falls off the disc is removed.
/// When the heap is at rest the height of its surface is read in rings, a grain wide, between 20
/// and 80 % of the disc's radius: the mean, over twelve sectors, of the highest top of a grain.
/// heap_angle: slope of the straight line through them.
///
/// Source: the fixed-base poured heap of Zhou, Xu, Yu & Zulli 2002, Powder Technology 125, 45-54,
/// with the lifted cylinder of ISO 902 practice in place of their outlet.
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/experiments/all.hpp"
#include "engine/filling.hpp"
#include "engine/refusal.hpp"
#include "engine/session.hpp"
#include "engine/surface_profile.hpp"

namespace repose::engine::experiments {

namespace {

struct Heap {
  struct Settings {
    double disc_diameter;
    double rim;
    double cylinder_diameter;
    double fill;
    double lift_speed;
    double time_step;
  };

  static constexpr ExperimentText text{
      .name = "heap",
      .title = "Heap on a disc",
      .summary = "A cylinder of grains is lifted off a disc: the slope of the heap that stays.",
      .procedure =
          "A cylinder on a rimmed disc is filled and lifted; what falls off is removed. When the "
          "heap is at rest a straight line is laid through the heights of its surface between "
          "20 and 80 % of the disc's radius.",
      .citation = "Zhou et al. 2002, Powder Technology 125, 45-54",
  };
  static constexpr std::array fields{
      Field<Settings>{&Settings::disc_diameter,
                      {.name = "disc_diameter",
                       .unit = unit::millimetre,
                       .meaning = "diameter of the disc the heap stands on",
                       .null_value = 0.15,
                       .lower = 0.01,
                       .upper = 2.0,
                       .draft = 0.095}},
      Field<Settings>{&Settings::rim,
                      {.name = "rim",
                       .unit = unit::one,
                       .meaning = "height of the disc's rim over the mean grain diameter",
                       .null_value = 1.0,
                       .lower = 0.0,
                       .upper = 5.0}},
      Field<Settings>{&Settings::cylinder_diameter,
                      {.name = "cylinder_diameter",
                       .unit = unit::millimetre,
                       .meaning = "inner diameter of the cylinder that is lifted",
                       .null_value = 0.08,
                       .lower = 5e-3,
                       .upper = 1.0,
                       .draft = 0.052}},
      Field<Settings>{&Settings::fill,
                      {.name = "fill",
                       .unit = unit::millimetre,
                       .meaning = "height to which the cylinder is filled",
                       .null_value = 0.12,
                       .lower = 5e-3,
                       .upper = 1.0,
                       .draft = 0.075}},
      Field<Settings>{&Settings::lift_speed,
                      {.name = "lift_speed",
                       .unit = unit::metre_per_second,
                       .meaning = "speed at which the cylinder is lifted",
                       .null_value = 0.05,
                       .lower = 1e-4,
                       .upper = 1.0}},
      Field<Settings>{&Settings::time_step,
                      {.name = "time_step",
                       .unit = unit::one,
                       .meaning = "time step over the Rayleigh time of the smallest grain",
                       .null_value = 0.2,
                       .lower = 0.01,
                       .upper = 1.0}},
  };
  static constexpr std::array observables{
      ObservableInfo{"heap_angle", unit::degree, "slope of the heap's surface", 0.04},
  };

  static std::string refuse(const Settings& s, double largest_grain_diameter);
  static Readings run(const Settings& s, Session& session);

 private:
  static bool fill(const Settings& s, Session& session);
  static bool lift(const Settings& s, Session& session);
  static Readings read(const Settings& s, Session& session);
};

/// Where the cylinder is among the walls: the last.
std::size_t cylinder_of(const World& world) { return world.surfaces().size() - 1; }

std::string Heap::refuse(const Settings& s, double largest_grain_diameter) {
  const double gap = 0.5 * (s.disc_diameter - s.cylinder_diameter);
  return too_short({{"disc_diameter", s.disc_diameter, 10.0},
                    {"cylinder_diameter", s.cylinder_diameter, 5.0},
                    {"the gap between cylinder_diameter and disc_diameter", gap, 2.0},
                    {"fill", s.fill, 5.0}},
                   largest_grain_diameter);
}

bool Heap::fill(const Settings& s, Session& session) {
  const double radius = 0.5 * s.cylinder_diameter;
  const Rain into_cylinder{.low_x = -radius,
                           .high_x = radius,
                           .low_y = -radius,
                           .high_y = radius,
                           .fits = [radius](const Vec3& centre, double r) {
                             return std::hypot(centre.x, centre.y) + r < radius;
                           }};
  if (!fill_to(session, into_cylinder, unit::pi * radius * radius * s.fill, s.fill)) return false;
  World& world = session.world();
  world.change_surfaces()[cylinder_of(world)].to_z = s.fill;
  session.stage("filled");
  return true;
}

bool Heap::lift(const Settings& s, Session& session) {
  constexpr double most_hanging = 0.2;  // of the grains; else it is the filling that sticks
  World& world = session.world();
  const std::size_t cylinder = cylinder_of(world);
  world.drive(cylinder, {0.0, 0.0, s.lift_speed});
  const auto edge = [&] { return world.surfaces()[cylinder].from_z; };
  const auto hangs = [&](const GrainRow& g) { return g.z + g.radius > edge(); };
  const auto& rows = world.grains().rows;
  while (edge() < 2.0 * s.fill && std::ranges::any_of(rows, hangs)) {
    if (!session.run_for(5e-3)) return false;
  }
  session.stage("lifted");
  const double share = static_cast<double>(std::ranges::count_if(rows, hangs)) /
                       static_cast<double>(std::max<std::size_t>(rows.size(), 1));
  if (share > most_hanging) {
    return session.fail(FailureKind::not_observed,
                        "the cylinder was lifted by twice `fill` and grains still hang in it: " +
                            quantity_text(share, unit::percent) + " of them");
  }
  world.remove(hangs);  // carried off with it
  world.change_surfaces().pop_back();
  return session.rest(10.0);
}

Readings Heap::read(const Settings& s, Session& session) {
  const double d = session.grain().diameter;
  const double radius = 0.5 * s.disc_diameter;
  const double from = 0.2 * radius;
  const double to = 0.8 * radius;
  const int rings = std::max(3, static_cast<int>(std::lround((to - from) / d)));
  const SurfaceProfile surface =
      ring_profile(session.world(), {.from = from, .to = to, .count = rings, .points = 12});
  const SurfaceProfile covered = covered_places(surface);
  if (covered.size() < surface.size()) {
    session.fail(FailureKind::not_observed,
                 "no heap formed: of " + std::to_string(surface.size()) +
                     " rings on the disc only " + std::to_string(covered.size()) +
                     " are covered with grains");
    return {};
  }
  const LineFit line = line_through(surface);
  const double rise = -line.slope * (to - from);
  if (rise < 0.5 * d) {
    session.fail(FailureKind::not_observed,
                 "no heap formed: the surface rises by " + quantity_text(rise, unit::millimetre) +
                     " from 80 to 20 % of the radius, less than half a grain");
    return {};
  }
  if (const double off = roughness(surface, line); off > d) {
    session.fail(FailureKind::not_observed,
                 "the heap has no slope: its surface is " + quantity_text(off, unit::millimetre) +
                     " off a straight line, more than a grain");
    return {};
  }
  return std::vector<Reading>{std::atan(-line.slope)};
}

Readings Heap::run(const Settings& s, Session& session) {
  const double d = session.grain().diameter;
  const double disc_radius = 0.5 * s.disc_diameter;
  const double room = s.disc_diameter;
  const double tall = 20.0 * s.fill;  // the cylinder while grains rain into it
  if (!session.set_up({.walls = {disc(disc_radius, 0.0, MaterialId::grain),
                                 cylinder(disc_radius, 0.0, s.rim * d, MaterialId::grain),
                                 cylinder(0.5 * s.cylinder_diameter, 0.0, tall)},
                       .period = {},
                       .low = {-room, -room, -2.0 * d},
                       .high = {room, room, tall},
                       .time_step_share = s.time_step,
                       .fastest = std::sqrt(2.0 * 9.81 * 4.0 * s.fill)})) {
    return {};
  }
  if (!fill(s, session)) return {};
  const std::uint64_t before = session.left_the_room();
  if (!lift(s, session)) return {};
  session.stage("at rest");
  if (session.left_the_room() == before) {
    session.fail(FailureKind::not_observed,
                 "the heap does not fill its base: no grain fell off the disc; `fill` is too low");
    return {};
  }
  return read(s, session);
}

constexpr auto settings = with_conditions(Heap::fields);

}  // namespace

constinit const ExperimentInfo heap = describe<Heap>(settings, refusal<Heap>, conduct<Heap>);

}  // namespace repose::engine::experiments
