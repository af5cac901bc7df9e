/// Drop: one grain falls on a rigid flat wall; its rebound gives the restitution.
///
/// Protocol: the grain is a sphere of mean volume, whatever the shape of grains, since a clump that
/// meets the wall off its centre turns instead of rebounding. Its underside is `height` above the
/// wall; it is released at rest, without spin; the first rebound's apex H_r of the underside is
/// read. restitution = sqrt(H_r / height).
///
/// Source: Boac et al. 2010, Trans. ASABE 53(4), 1201-1216 (drop test from 151 mm on steel).
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/experiments/all.hpp"
#include "engine/session.hpp"

namespace repose::engine::experiments {

namespace {

struct Drop {
  struct Settings {
    double height;
    double steps_per_impact;
  };

  static constexpr ExperimentText text{
      .name = "drop",
      .title = "Drop test",
      .summary = "One grain falls on a flat wall; how high it rebounds gives the restitution.",
      .procedure =
          "A spherical grain of mean volume is released at rest, without spin, its underside at "
          "`height` above a rigid flat wall. The apex of the underside after the first impact is "
          "read.",
      .citation = "Boac et al. 2010, Trans. ASABE 53(4), 1201-1216",
  };
  static constexpr std::array fields{
      Field<Settings>{&Settings::height,
                      {.name = "height",
                       .unit = unit::millimetre,
                       .meaning = "underside of the grain above the wall at release",
                       .null_value = 0.151,
                       .lower = 1e-3,
                       .upper = 5.0}},
      Field<Settings>{&Settings::steps_per_impact,
                      {.name = "steps_per_impact",
                       .unit = unit::one,
                       .meaning = "time steps in which the impact is resolved",
                       .null_value = 200.0,
                       .lower = 10.0,
                       .upper = 1e5}},
  };
  static constexpr std::array observables{
      ObservableInfo{
          "restitution", unit::one, "square root of rebound height over drop height", 0.002},
  };

  static Readings run(const Settings& s, Session& session);
};

Readings Drop::run(const Settings& s, Session& session) {
  const double radius = 0.5 * session.grain().diameter;
  const double speed = std::sqrt(2.0 * 9.81 * s.height);
  const double impact = session.impact_time_at(speed);
  const double share = impact / s.steps_per_impact / session.rayleigh();
  const double room = 2.0 * s.height + 10.0 * radius;
  if (!session.set_up({.walls = {plane(0.0)},
                       .period = {},
                       .low = {-room, -room, -radius},
                       .high = {room, room, room},
                       .time_step_share = std::min(0.2, share),
                       .fastest = speed,
                       .closed = true})) {
    return {};
  }
  GrainRow grain = sphere(radius, session.grain().density);
  grain.z = s.height + radius;
  session.request(1);
  session.world().add(grain);
  session.stage("released");

  const double fall = std::sqrt(2.0 * s.height / 9.81);
  const double step = session.world().time_step();
  const auto& rows = session.world().grains().rows;
  if (!session.until([&] { return rows[0].vz > 0.0; },
                     step,
                     2.0 * fall + 10.0 * impact,
                     FailureKind::not_observed,
                     "the grain did not rebound")) {
    return {};
  }
  double apex = 0.0;
  const auto falls_again = [&] {
    apex = std::max(apex, rows[0].z - radius);
    return rows[0].vz <= 0.0;
  };
  if (!session.until(falls_again,
                     step,
                     2.0 * fall + 10.0 * impact,
                     FailureKind::not_observed,
                     "the rebound has no apex")) {
    return {};
  }
  session.stage("apex");
  return std::vector<Reading>{std::sqrt(apex / s.height)};
}

constexpr auto settings = with_conditions(Drop::fields);

}  // namespace

constinit const ExperimentInfo drop = describe<Drop>(settings, refusal<Drop>, conduct<Drop>);

}  // namespace repose::engine::experiments
