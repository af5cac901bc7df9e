/// Drum: a ribbed drum turns about its level axis; the slope of the surface that flows is read.
///
/// Protocol: a drum, endless (periodic) along its axis, its mantle and ribs covered with grains'
/// stuff, is filled to `fill` of its volume with a bed and comes to rest, or has five seconds for
/// it after either half. It turns at `speed`.
/// After 0.35 turns and at least a second the slope of the surface over the middle 55 % of the
/// radius is read every hundredth of a second for two seconds. dynamic_angle: its mean.
///
/// Source: rotating-drum test, Mellmann 2001, Powder Technology 118, 251-270 (rolling bed and
/// its angle); lifters one grain high so that the bed does not slide as a whole.
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

constexpr double gravity = 9.81;  // m/s2

struct Drum {
  struct Settings {
    double diameter;
    double length;
    double fill;
    double speed;
    double ribs;
    double seconds;
    double time_step;
  };

  static constexpr ExperimentText text{
      .name = "drum",
      .title = "Rotating drum",
      .summary = "A ribbed drum turns about its level axis: the slope of the surface that flows.",
      .procedure =
          "The drum is filled with a bed at rest and turned. After 0.35 turns and at least a "
          "second a straight line is laid through the surface over the middle 55 % of the radius, "
          "again and again; the angle is their mean. Grains that hang from the mantle overhead "
          "are not of the surface.",
      .citation = "Mellmann 2001, Powder Technology 118, 251-270",
  };
  static constexpr std::array fields{
      Field<Settings>{&Settings::diameter,
                      {.name = "diameter",
                       .unit = unit::millimetre,
                       .meaning = "inner diameter of the drum",
                       .null_value = 0.15,
                       .lower = 0.01,
                       .upper = 2.0,
                       .draft = 0.106}},
      Field<Settings>{&Settings::length,
                      {.name = "length",
                       .unit = unit::millimetre,
                       .meaning = "length of the drum, periodic",
                       .null_value = 0.04,
                       .lower = 5e-3,
                       .upper = 1.0,
                       .draft = 0.025}},
      Field<Settings>{&Settings::fill,
                      {.name = "fill",
                       .unit = unit::one,
                       .meaning = "share of the drum's volume that the bed takes up",
                       .null_value = 0.4,
                       .lower = 0.15,
                       .upper = 0.6}},
      Field<Settings>{&Settings::speed,
                      {.name = "speed",
                       .unit = unit::revolution_per_minute,
                       .meaning = "speed of rotation",
                       .null_value = 15.0 * unit::revolution_per_minute.factor,
                       .lower = 0.1 * unit::revolution_per_minute.factor,
                       .upper = 1000.0 * unit::revolution_per_minute.factor}},
      Field<Settings>{&Settings::ribs,
                      {.name = "ribs",
                       .unit = unit::one,
                       .meaning = "radial ribs on the mantle, a mean grain diameter high",
                       .null_value = 16.0,
                       .lower = 0.0,
                       .upper = 64.0}},
      Field<Settings>{&Settings::seconds,
                      {.name = "seconds",
                       .unit = unit::second,
                       .meaning = "time over which the angle is read",
                       .null_value = 2.0,
                       .lower = 0.1,
                       .upper = 100.0,
                       .draft = 0.6}},
      Field<Settings>{&Settings::time_step,
                      {.name = "time_step",
                       .unit = unit::one,
                       .meaning = "time step over the Rayleigh time of the smallest grain",
                       .null_value = 0.2,
                       .lower = 0.01,
                       .upper = 1.0}},
  };
  static constexpr std::array observables{
      ObservableInfo{"dynamic_angle", unit::degree, "mean slope of the surface that flows", 0.07},
  };

  static std::string refuse(const Settings& s, double largest_grain_diameter);
  static Readings run(const Settings& s, Session& session);

 private:
  static bool fill_drum(const Settings& s, Session& session);
  static Readings read(const Settings& s, Session& session);
};

std::string Drum::refuse(const Settings& s, double largest_grain_diameter) {
  const double radius = 0.5 * s.diameter;
  const double fastest = std::sqrt(gravity / radius);
  std::string speed;
  if (s.speed >= fastest) {
    speed = "speed = " + quantity_text(s.speed, unit::revolution_per_minute) +
            " centrifuges: it must be below " +
            quantity_text(fastest, unit::revolution_per_minute) +
            ", where the mantle's acceleration is gravity's";
  }
  return both(too_short({{"diameter", s.diameter, 10.0}, {"length", s.length, 3.0}},
                        largest_grain_diameter),
              speed);
}

/// Rain fills a drum to less than half: the rest comes down on what lies there.
bool Drum::fill_drum(const Settings& s, Session& session) {
  constexpr double solid_fraction = 0.6;
  constexpr double portion = 0.6;
  const double radius = 0.5 * s.diameter;
  const double clear = radius - session.grain().diameter;
  const double volume = unit::pi * radius * radius * s.length;
  const double mass = s.fill * solid_fraction * volume * session.grain().density;
  const auto wanted = static_cast<std::uint64_t>(mass / session.grain_mass());
  std::uint64_t put = 0;
  while (put < wanted) {
    double top = 0.0;
    for (const GrainRow& g : session.world().grains().rows) top = std::max(top, g.z + g.radius);
    const auto now = static_cast<std::uint64_t>(portion * static_cast<double>(wanted)) + 1;
    const std::uint64_t added =
        rain(session,
             {.low_x = -radius,
              .high_x = radius,
              .low_y = 0.0,
              .high_y = s.length,
              .bottom = top,
              .grains = std::min(now, wanted - put),
              .fits = [clear, radius](
                          const Vec3& centre,
                          double r) { return std::hypot(centre.x, centre.z - radius) + r < clear; },
              .top = s.diameter});
    if (added == 0) {
      return session.fail(FailureKind::did_not_fill,
                          "the drum holds " + std::to_string(put) + " grains of " +
                              std::to_string(wanted) + " asked for");
    }
    put += added;
    session.comes_to_rest(5.0);  // or not: turning forgets how it lay
    if (session.failed()) return false;
  }
  session.stage("filled");
  return true;
}

/// Share of the mantle's speed with which grains at it move; below a half the bed slides.
double carried(const Drum::Settings& s, const World& world) {
  const double radius = 0.5 * s.diameter;
  double sum = 0.0;
  int grains = 0;
  for (const GrainRow& g : world.grains().rows) {
    const double x = g.x, z = g.z - radius, away = std::hypot(x, z);
    if (radius - away > 1.1 * g.radius) continue;
    sum += (z * g.vx - x * g.vz) / (away * s.speed * radius);
    ++grains;
  }
  return grains > 0 ? sum / grains : 1.0;
}

Readings Drum::read(const Settings& s, Session& session) {
  constexpr double every = 0.01;  // s
  const double radius = 0.5 * s.diameter;
  const Places middle{.from = -0.55 * radius, .to = 0.55 * radius, .count = 24, .points = 24};
  const double rib = session.grain().diameter;
  // Overhead, what touches the mantle or a rib hangs there.
  const auto of_bed = [radius, rib](const GrainRow& g) {
    return g.z < radius || radius - std::hypot(g.x, g.z - radius) > rib + g.radius;
  };
  double angles = 0.0, grip = 0.0, bare = 0.0;
  int looks = 0;
  const double end = session.world().time() + s.seconds;
  while (session.world().time() < end) {
    if (!session.run_for(every)) return {};
    const SurfaceProfile surface = straight_profile(session.world(), middle, of_bed);
    const SurfaceProfile covered = covered_places(surface);
    bare +=
        static_cast<double>(surface.size() - covered.size()) / static_cast<double>(surface.size());
    if (covered.size() < 2) continue;
    // The bed climbs on the side that goes up: at negative x, as the drum turns about +y.
    angles += std::atan(-line_through(covered).slope);
    grip += carried(s, session.world());
    ++looks;
  }
  if (looks == 0 || bare / looks > 0.1) {
    session.fail(FailureKind::not_observed,
                 "the bed does not cover the middle of the drum: there is no surface to read");
    return {};
  }
  if (grip / looks < 0.5) {
    session.fail(FailureKind::not_observed,
                 "the bed slides as a whole: grains at the mantle move at " +
                     quantity_text(grip / looks, unit::percent) + " of its speed");
    return {};
  }
  return std::vector<Reading>{angles / looks};
}

Readings Drum::run(const Settings& s, Session& session) {
  const double radius = 0.5 * s.diameter;
  const double d = session.grain().diameter;
  std::vector<Surface> walls{lying_cylinder(radius, 0.0, radius, MaterialId::grain)};
  const auto ribs = lying_ribs(static_cast<int>(s.ribs), radius, d, 0.0, radius, MaterialId::grain);
  walls.insert(walls.end(), ribs.begin(), ribs.end());
  if (!session.set_up({.walls = walls,
                       .period = {0.0, s.length, 0.0},
                       .low = {-s.diameter, -1e3, -s.diameter},
                       .high = {s.diameter, 1e3, 2.0 * s.diameter},
                       .time_step_share = s.time_step,
                       .fastest = std::sqrt(2.0 * gravity * s.diameter),
                       .closed = true})) {
    return {};
  }
  if (!fill_drum(s, session)) return {};
  for (std::size_t k = 0; k < walls.size(); ++k) {
    session.world().drive(k, {}, {0.0, s.speed, 0.0});
  }
  const double turn = 2.0 * unit::pi / s.speed;
  if (!session.run_for(std::max(1.0, 0.35 * turn))) return {};
  session.stage("flowing");
  Readings readings = read(s, session);
  session.stage("at the end");
  return readings;
}

constexpr auto settings = with_conditions(Drum::fields);

}  // namespace

constinit const ExperimentInfo drum = describe<Drum>(settings, refusal<Drum>, conduct<Drum>);

}  // namespace repose::engine::experiments
