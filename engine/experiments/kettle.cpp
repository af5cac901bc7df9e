/// Kettle: grains run into a test-weight kettle until it overflows; its bulk density is read.
///
/// Protocol: a kettle stands on a floor, its axis upright. Grains fall into it in a round stream
/// that starts at `drop` above the rim (or, `source` = hopper, out of a conical hopper with an
/// opening of the stream's diameter: the density is the same within 0.5 kg/m3, at about twice the
/// cost). What overflows falls off and is removed. When a hundredth
/// of the kettle's content has overflowed the source is taken away; when all grains are at rest,
/// those above the rim are struck off: bulk_density = mass of the grains whose centre is inside
/// below the rim / volume of the kettle. (`rim` = whole: of the grains that lie below the rim
/// wholly, a clump as the sphere that holds it.)
///
/// Source: USDA GIPSA test weight apparatus as used by Boac et al. 2010, Trans. ASABE 53(4),
/// 1201-1216.
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/experiments/all.hpp"
#include "engine/filling.hpp"
#include "engine/refusal.hpp"
#include "engine/session.hpp"

namespace repose::engine::experiments {

namespace {

constexpr std::array<std::string_view, 2> sources{"hopper", "stream"};
constexpr std::array<std::string_view, 2> rims{"centre", "whole"};

struct Kettle {
  struct Settings {
    double diameter;
    double height;
    double opening;
    double drop;
    double source;
    double rate;
    double speed;
    double rim;
    double time_step;
  };

  static constexpr ExperimentText text{
      .name = "kettle",
      .title = "Test-weight kettle",
      .summary =
          "Grains run into a kettle until it overflows; their mass inside gives the bulk density.",
      .procedure =
          "Grains fall from a conical hopper (or a stream) above the kettle's middle until a "
          "hundredth of its content has overflowed. The source is taken away, the grains come "
          "to rest, those with their centre above the rim are struck off.",
      .citation = "Boac et al. 2010, Trans. ASABE 53(4), 1201-1216",
  };
  static constexpr std::array fields{
      Field<Settings>{&Settings::diameter,
                      {.name = "diameter",
                       .unit = unit::millimetre,
                       .meaning = "inner diameter of the kettle",
                       .null_value = 0.117475,
                       .lower = 5e-3,
                       .upper = 1.0,
                       .draft = 0.075}},
      Field<Settings>{&Settings::height,
                      {.name = "height",
                       .unit = unit::millimetre,
                       .meaning = "inner height of the kettle",
                       .null_value = 0.1016,
                       .lower = 5e-3,
                       .upper = 1.0,
                       .draft = 0.065}},
      Field<Settings>{&Settings::opening,
                      {.name = "opening",
                       .unit = unit::millimetre,
                       .meaning = "diameter of the opening the grains fall from",
                       .null_value = 0.03175,
                       .lower = 1e-3,
                       .upper = 0.5}},
      Field<Settings>{&Settings::drop,
                      {.name = "drop",
                       .unit = unit::millimetre,
                       .meaning = "opening above the rim",
                       .null_value = 0.0508,
                       .lower = 5e-3,
                       .upper = 1.0}},
      Field<Settings>{&Settings::source,
                      {.name = "source",
                       .unit = unit::one,
                       .meaning = "what the grains fall from",
                       .null_value = 1.0,
                       .lower = 0.0,
                       .upper = 1.0,
                       .paper = 0.0,
                       .choices = sources}},
      Field<Settings>{
          &Settings::rate,
          {.name = "rate",
           .unit = unit::kilogram_per_second,
           .meaning = "mass flow of the stream; less where the stream has no room for it",
           .null_value = 0.2,
           .lower = 1e-4,
           .upper = 10.0}},
      Field<Settings>{&Settings::speed,
                      {.name = "speed",
                       .unit = unit::metre_per_second,
                       .meaning = "speed at which the stream starts",
                       .null_value = 0.5,
                       .lower = 0.01,
                       .upper = 10.0}},
      Field<Settings>{&Settings::rim,
                      {.name = "rim",
                       .unit = unit::one,
                       .meaning = "what of a grain must lie below the rim for it to be counted",
                       .null_value = 0.0,
                       .lower = 0.0,
                       .upper = 1.0,
                       .choices = rims}},
      Field<Settings>{&Settings::time_step,
                      {.name = "time_step",
                       .unit = unit::one,
                       .meaning = "time step over the Rayleigh time of the smallest grain",
                       .null_value = 0.2,
                       .lower = 0.01,
                       .upper = 1.0}},
  };
  static constexpr std::array observables{
      ObservableInfo{"bulk_density",
                     unit::kilogram_per_cubic_metre,
                     "mass of the grains inside below the rim over the kettle's volume",
                     0.01},
  };

  static std::string refuse(const Settings& s, double largest_grain_diameter);
  static Readings run(const Settings& s, Session& session);

 private:
  /// Mass of the grains that count, kg.
  static double mass_inside(const Settings& s, const World& world);
  static bool is_full(const Settings& s, Session& session);
  static bool pour_from_hopper(const Settings& s, Session& session);
  static bool pour_from_stream(const Settings& s, Session& session);
  static bool overflow(const Settings& s,
                       Session& session,
                       const std::function<void()>& feed,
                       double limit);
  /// Grains that fill the kettle at the density of a close random packing.
  static double capacity(const Settings& s, const Session& session) {
    constexpr double solid_fraction = 0.64;
    return solid_fraction * volume(s) * session.grain().density / session.grain_mass();
  }
  static double volume(const Settings& s) {
    return unit::pi / 4.0 * s.diameter * s.diameter * s.height;
  }
};

/// Pours until a hundredth of the kettle's content has overflowed.
bool Kettle::overflow(const Settings& s,
                      Session& session,
                      const std::function<void()>& feed,
                      double limit) {
  const auto enough = static_cast<std::uint64_t>(std::ceil(0.01 * capacity(s, session)));
  const std::uint64_t before = session.left_the_room();
  const auto flows_over = [&] {
    feed();
    return session.left_the_room() - before >= enough;
  };
  session.world().start_shaking();
  const bool full =
      session.until(flows_over,
                    5e-3,
                    limit,
                    FailureKind::did_not_fill,
                    "the kettle did not overflow: the source has arched or run empty");
  session.world().stop_shaking();
  return full;
}

bool Kettle::pour_from_stream(const Settings& s, Session& session) {
  Stream stream(session,
                {.radius = 0.5 * s.opening,
                 .bottom = s.height + s.drop,
                 .height = 4.0 * session.grain().diameter,
                 .rate = s.rate / session.grain_mass(),
                 .speed = s.speed});
  const double expected = volume(s) * session.grain().density / s.rate;
  return overflow(
      s, session, [&stream] { stream.feed(); }, 4.0 * expected + 2.0);
}

bool Kettle::pour_from_hopper(const Settings& s, Session& session) {
  // The hopper holds a third more than the kettle, filled loosely; its mantle stands at 60 degrees.
  const double rise = std::sqrt(3.0);
  const double wanted = 1.35 * capacity(s, session);
  const double loose = wanted * session.grain_mass() / session.grain().density / 0.5;
  const double a = 0.5 * s.opening;
  const double top = std::cbrt(3.0 * loose / (unit::pi * rise) + a * a * a);
  const double low = s.height + s.drop;
  auto& walls = session.world().change_surfaces();
  walls.push_back(cone(a, low, 4.0 * top, low + rise * (4.0 * top - a)));
  walls.push_back(disc(a, low));
  const std::uint64_t put = rain(session,
                                 {.low_x = -top,
                                  .high_x = top,
                                  .low_y = -top,
                                  .high_y = top,
                                  .bottom = low,
                                  .grains = static_cast<std::uint64_t>(wanted),
                                  .fits = [a, low, rise](const Vec3& centre, double r) {
                                    // Clear of the mantle: distance to its line in the half plane.
                                    const double rho =
                                        std::sqrt(centre.x * centre.x + centre.y * centre.y);
                                    const double mantle = a + (centre.z - low) / rise;
                                    return (mantle - rho) * std::sin(unit::pi / 3.0) > 1.05 * r;
                                  }});
  if (put < static_cast<std::uint64_t>(wanted)) {
    return session.fail(FailureKind::did_not_fill,
                        "the hopper holds " + std::to_string(put) + " grains of " +
                            std::to_string(static_cast<std::uint64_t>(wanted)) + " asked for");
  }
  if (!session.rest(5.0)) return false;
  session.stage("hopper filled");
  // An opening of five grains gives 0.1 kg/s (Beverloo's law); a fifth of that is still a flow.
  const double limit = 5.0 + volume(s) * session.grain().density * 0.64 / 0.02;
  session.world().change_surfaces().pop_back();
  return overflow(
      s, session, [] {}, limit);
}

std::string Kettle::refuse(const Settings& s, double largest_grain_diameter) {
  std::string wide;
  if (s.opening > s.diameter) {
    wide = "opening = " + quantity_text(s.opening, unit::millimetre) +
           " pours beside the kettle: it must be at most the diameter, " +
           quantity_text(s.diameter, unit::millimetre);
  }
  return both(
      too_short(
          {{"diameter", s.diameter, 5.0}, {"height", s.height, 3.0}, {"opening", s.opening, 3.0}},
          largest_grain_diameter),
      wide);
}

/// Whether there are half as many grains just below the rim as a packed bed has there.
bool Kettle::is_full(const Settings& s, Session& session) {
  const double radius = 0.5 * s.diameter;
  const double d = session.grain().diameter;
  double there = 0.0;
  session.world().for_each_grain([&](const GrainRow& g, std::uint32_t /*id*/) {
    const Vec3 c = g.centre();
    const bool inside = c.x * c.x + c.y * c.y < radius * radius;
    if (inside && c.z < s.height && c.z > s.height - d) there += 1.0;
  });
  return there >= 0.5 * capacity(s, session) * d / s.height;
}

double Kettle::mass_inside(const Settings& s, const World& world) {
  const double radius = 0.5 * s.diameter;
  const double above_centre = s.rim == 0.0 ? 0.0 : 1.0;  // radii of the grain
  double total = 0.0;
  world.for_each_grain([&](const GrainRow& g, std::uint32_t /*id*/) {
    const Vec3 c = g.centre();
    const bool below = c.z > 0.0 && c.z + above_centre * g.radius < s.height;
    if (below && c.x * c.x + c.y * c.y < radius * radius) total += mass(g);
  });
  return total;
}

Readings Kettle::run(const Settings& s, Session& session) {
  const double rim = 0.5 * s.diameter;
  const double d = session.grain().diameter;
  const double low = s.height + s.drop;
  const double room = 10.0 * s.diameter;
  const double fall = 2.0 * 9.81 * (low + 4.0 * d);
  if (!session.set_up({.walls = {disc(rim, 0.0), cylinder(rim, 0.0, s.height)},
                       .period = {},
                       .low = {-room, -room, -0.02},
                       .high = {room, room, low + room},
                       .time_step_share = s.time_step,
                       .fastest = std::sqrt(s.speed * s.speed + fall)})) {
    return {};
  }
  const bool hopper = s.source == 0.0;
  if (!(hopper ? pour_from_hopper(s, session) : pour_from_stream(s, session))) return {};
  strike_off(session, low - d);  // the source is taken away
  if (hopper) session.world().change_surfaces().pop_back();
  if (!session.rest(10.0)) return {};
  session.stage("filled");
  if (!is_full(s, session)) {
    session.fail(FailureKind::did_not_fill, "the kettle is not full to its rim");
    return {};
  }
  return std::vector<Reading>{mass_inside(s, session.world()) / volume(s)};
}

constexpr auto settings = with_conditions(Kettle::fields);

}  // namespace

constinit const ExperimentInfo kettle =
    describe<Kettle>(settings, refusal<Kettle>, conduct<Kettle>);

}  // namespace repose::engine::experiments
