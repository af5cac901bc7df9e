/// Draw-down: a flat-bottomed silo empties through a slot; its flow and what stays are read.
///
/// Protocol: a silo, endless (periodic) across its width, with upright ends and a floor covered
/// with grains' stuff, is filled past `depth`, comes to rest, is struck off at `depth` and comes to
/// rest. A slot across the middle of the floor opens at once. When less than a thousandth of the
/// filling has passed in a quarter of a second and the grains are at rest, two slopes stand on the
/// floor.
/// discharge_rate: slope of the straight line through the discharged mass against time between 20
/// and 70 % of the final one, over the slot's length. drain_angle: mean slope of the two surfaces,
/// each a straight line through its height between 20 and 80 % of the way from the slot to the end,
/// where grains cover the floor and as far as the filling's own surface is out of reach; zero for a
/// side where less than a fifth of the floor stays covered, for nothing stands there.
///
/// Source: the draw-down test as in Rackl & Hanley 2017, Powder Technology 307, 73-83; steady flow
/// from a slot: Beverloo, Leniger & van de Velde 1961, Chem. Eng. Sci. 15, 260-269.
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/experiments/all.hpp"
#include "engine/filling.hpp"
#include "engine/instrument.hpp"
#include "engine/refusal.hpp"
#include "engine/session.hpp"
#include "engine/surface_profile.hpp"

namespace repose::engine::experiments {

namespace {

struct DrawDown {
  struct Settings {
    double length;
    double width;
    double depth;
    double slot;
    double time_step;
  };

  static constexpr ExperimentText text{
      .name = "draw_down",
      .title = "Draw-down from a silo",
      .summary = "A flat-bottomed silo empties through a slot: its flow, and the slopes that stay.",
      .procedure =
          "The silo is filled, struck off at `depth` and left to rest; a slot across the middle "
          "of its floor opens at once. Discharged mass is followed until the flow has ended; then "
          "straight lines are laid through the two surfaces that stay.",
      .citation = "Rackl & Hanley 2017, Powder Technology 307, 73-83",
  };
  static constexpr std::array fields{
      Field<Settings>{&Settings::length,
                      {.name = "length",
                       .unit = unit::millimetre,
                       .meaning = "inner length of the silo, across the slot",
                       .null_value = 0.24,
                       .lower = 0.02,
                       .upper = 2.0,
                       .draft = 0.165}},
      Field<Settings>{&Settings::width,
                      {.name = "width",
                       .unit = unit::millimetre,
                       .meaning = "width of the silo along the slot, periodic",
                       .null_value = 0.04,
                       .lower = 5e-3,
                       .upper = 1.0,
                       .draft = 0.024}},
      Field<Settings>{&Settings::depth,
                      {.name = "depth",
                       .unit = unit::millimetre,
                       .meaning = "height to which the silo is filled",
                       .null_value = 0.10,
                       .lower = 5e-3,
                       .upper = 1.0,
                       .draft = 0.068}},
      Field<Settings>{&Settings::slot,
                      {.name = "slot",
                       .unit = unit::millimetre,
                       .meaning = "opening of the slot",
                       .null_value = 0.05,
                       .lower = 1e-3,
                       .upper = 0.5}},
      Field<Settings>{&Settings::time_step,
                      {.name = "time_step",
                       .unit = unit::one,
                       .meaning = "time step over the Rayleigh time of the smallest grain",
                       .null_value = 0.2,
                       .lower = 0.01,
                       .upper = 1.0}},
  };
  static constexpr std::array observables{
      ObservableInfo{"discharge_rate",
                     unit::kilogram_per_second_metre,
                     "mass that passes in a unit of time through a unit of the slot's length",
                     0.02},
      ObservableInfo{"drain_angle",
                     unit::degree,
                     "mean slope of the two surfaces that stay; 0 if the silo runs empty",
                     0.05},
  };

  static std::string refuse(const Settings& s, double largest_grain_diameter);
  static Readings run(const Settings& s, Session& session);
};

constexpr double rest_limit = 10.0;  // s, of what stays when the flow has ended

/// From an edge of the slot to the end of the silo, m.
double floor_beside(const DrawDown::Settings& s) { return 0.5 * (s.length - s.slot); }

/// Mass that has left through the slot, at times after it opened.
struct Discharge {
  std::vector<double> time;  ///< s
  std::vector<double> mass;  ///< kg
  bool at_rest = false;      ///< what stays is, at the end
};

bool fill(const DrawDown::Settings& s, Session& session) {
  const Rain between_ends{
      .low_x = 0.0, .high_x = s.length, .low_y = 0.0, .high_y = s.width, .fits = {}};
  if (!fill_to(session, between_ends, s.length * s.width * s.depth, s.depth)) return false;
  std::vector<Surface>& walls = session.world().change_surfaces();
  for (std::size_t end = 0; end < 2; ++end) walls[end].to_z = s.depth;
  session.stage("filled");
  return true;
}

/// Follows the discharged mass until next to nothing passes, and waits for what stays to rest.
std::optional<Discharge> empty(Session& session) {
  constexpr double patience = 0.25;    // s
  constexpr double trickle = 1e-3;     // of the filling, in that time
  constexpr double watch = 2e-3;       // s
  constexpr double flow_limit = 30.0;  // s
  World& world = session.world();
  const auto held = [&world] { return mass_where(world, [](const Vec3& c) { return c.z > 0.0; }); };
  const double start = world.time();
  const double filling = held();
  Discharge discharge;
  std::size_t earlier = 0;  // the sample `patience` ago
  const auto ended = [&] {
    discharge.time.push_back(world.time() - start);
    discharge.mass.push_back(filling - held());
    if (discharge.time.back() < patience) return false;
    while (discharge.time[earlier + 1] <= discharge.time.back() - patience) ++earlier;
    return discharge.mass.back() - discharge.mass[earlier] < trickle * filling;
  };
  if (!session.until(ended,
                     watch,
                     flow_limit,
                     FailureKind::did_not_rest,
                     "grains were still flowing after 30 s")) {
    return {};
  }
  discharge.at_rest = session.comes_to_rest(rest_limit);
  if (session.failed()) return {};
  discharge.time.push_back(world.time() - start);
  discharge.mass.push_back(filling - held());
  return discharge;
}

/// Whether the flow ended because the slot is free of grains, not because they arch over it.
bool ran_empty(const DrawDown::Settings& s, Session& session, const Discharge& discharge) {
  const auto above_slot = [&s](const Vec3& c) {
    return c.z > 0.0 && std::abs(c.x - 0.5 * s.length) < 0.25 * s.slot;
  };
  const double left = mass_where(session.world(), above_slot);
  if (left == 0.0) return true;
  const double gone = discharge.mass.back();
  const double all = gone + mass_where(session.world(), [](const Vec3& c) { return c.z > 0.0; });
  const auto percent = [all](double mass) {
    return std::to_string(std::lround(100.0 * mass / all));
  };
  return session.fail(FailureKind::not_observed,
                      "the silo has arched: nothing flows although " + percent(left) +
                          " % of the filling stand above the middle of the slot; " + percent(gone) +
                          " % had passed");
}

/// Mass per time between 20 and 70 % of what was discharged, kg/s.
Reading flow(const Discharge& discharge) {
  constexpr double from = 0.2, to = 0.7;
  constexpr std::size_t fewest = 10;  // samples of a line
  constexpr double steady = 0.05;     // rms from the line over the mass discharged
  const double total = discharge.mass.back();
  std::vector<double> time;
  std::vector<double> mass;
  for (std::size_t i = 0; i < discharge.mass.size(); ++i) {
    if (discharge.mass[i] < from * total || discharge.mass[i] > to * total) continue;
    time.push_back(discharge.time[i]);
    mass.push_back(discharge.mass[i]);
  }
  if (time.size() < fewest) {
    return Unexpected{std::string("too little was discharged to read a rate")};
  }
  const LineFit line = fit_line(time, mass);
  double off = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    off += std::pow(mass[i] - line.intercept - line.slope * time[i], 2.0);
  }
  if (std::sqrt(off / static_cast<double>(time.size())) > steady * total) {
    return Unexpected{std::string("the flow was not steady: it halted on the way")};
  }
  return line.slope;
}

/// Tangent of the slope that stands on one side of the slot; `side` is -1 (left) or 1.
Reading slope(const DrawDown::Settings& s, Session& session, double side) {
  constexpr std::size_t places = 30;
  constexpr std::size_t fewest = 10;  // that are covered, for a line: a fifth of the floor
  const double d = session.grain().diameter;
  const double run = floor_beside(s);
  const double edge = 0.5 * (s.length + side * s.slot);
  const double inner = edge + side * 0.2 * run;
  const double outer = edge + side * 0.8 * run;
  SurfaceProfile surface = straight_profile(session.world(),
                                            {.from = std::min(inner, outer),
                                             .to = std::max(inner, outer),
                                             .count = places,
                                             .points = 60});
  if (side < 0.0) std::ranges::reverse(surface);
  // The slope ends where it meets the level surface that was struck off.
  const auto level =
      std::ranges::find_if(surface, [&](const SurfaceHeight& p) { return p.height > s.depth - d; });
  surface.erase(level, surface.end());
  const SurfaceProfile covered = covered_places(surface);
  if (covered.size() < fewest) {
    if (surface.size() == places) return 0.0;  // it ran empty to the end
    return Unexpected{"no slope stands beside the slot: of " + std::to_string(surface.size()) +
                      " places below the level surface " + std::to_string(covered.size()) +
                      " are covered with grains"};
  }
  // Where grains slip and roll with ease, the foot of the slope stands away from the slot.
  const LineFit line = line_through(covered);
  if (const double off = roughness(covered, line); off > d) {
    return Unexpected{"the surface beside the slot is " + quantity_text(off, unit::millimetre) +
                      " off a straight line, more than a grain"};
  }
  return side * line.slope;
}

/// Mean of the two slopes, rad.
Reading drain_angle(const DrawDown::Settings& s, Session& session, const Discharge& discharge) {
  const Reading left = slope(s, session, -1.0);
  if (!left) return left;
  const Reading right = slope(s, session, 1.0);
  if (!right) return right;
  const double angle = 0.5 * (std::atan(*left) + std::atan(*right));
  if (angle != 0.0 && !discharge.at_rest) {
    return Unexpected{"what stays was still moving after " +
                      std::to_string(std::lround(rest_limit)) + " s"};
  }
  return angle;
}

std::string DrawDown::refuse(const Settings& s, double largest_grain_diameter) {
  return too_short({{"slot", s.slot, 3.0},
                    {"width", s.width, 3.0},
                    {"depth", s.depth, 5.0},
                    {"the floor from slot to end, (length - slot) / 2,", floor_beside(s), 7.0}},
                   largest_grain_diameter);
}

Readings DrawDown::run(const Settings& s, Session& session) {
  const double d = session.grain().diameter;
  const double left = floor_beside(s);
  const double right = left + s.slot;
  const double tall = 20.0 * s.depth;  // the ends while grains rain in
  // The slot's cover is the last wall: it is taken away to open it.
  if (!session.set_up({.walls = {upright(0.0, 0.0, tall),
                                 upright(s.length, 0.0, tall),
                                 strip(0.0, left, 0.0, MaterialId::grain),
                                 strip(right, s.length, 0.0, MaterialId::grain),
                                 strip(left, right, 0.0, MaterialId::grain)},
                       .period = {0.0, s.width, 0.0},
                       .low = {-s.length, -1e3, -2.0 * d},
                       .high = {2.0 * s.length, 1e3, tall},
                       .time_step_share = s.time_step,
                       .fastest = std::sqrt(2.0 * 9.81 * 4.0 * s.depth)})) {
    return {};
  }
  if (!fill(s, session)) return {};
  session.world().change_surfaces().pop_back();
  const std::optional<Discharge> discharge = empty(session);
  if (!discharge) return {};
  session.stage("emptied");
  if (!ran_empty(s, session, *discharge)) return {};
  const Reading flowing = flow(*discharge);
  const Reading rate = flowing ? Reading(*flowing / s.width) : flowing;
  return std::vector{rate, drain_angle(s, session, *discharge)};
}

constexpr auto settings = with_conditions(DrawDown::fields);

}  // namespace

constinit const ExperimentInfo draw_down =
    describe<DrawDown>(settings, refusal<DrawDown>, conduct<DrawDown>);

}  // namespace repose::engine::experiments
