/// Compression: a bed between a base and a platen, squeezed and let go; its stiffness and what does
/// not spring back are read.
///
/// Protocol: a bed, endless (periodic) sideways, is filled past `depth`, comes to rest, is struck
/// off and comes to rest. A flat platen comes down at `speed` until the stress at the base, less
/// the bed's own weight, reaches `overshoot` times `stress`, and goes back at the same speed until
/// a fortieth of the largest stress is left. Strain is the platen's way over its height above the
/// base when it first bore a hundredth of `stress`; it is counted from where the stress first
/// passed a twentieth of its maximum, so that both ends of what does not spring back bear alike.
/// secant_modulus: difference of stress over difference of strain between a quarter of `stress` and
/// `stress`, on loading. residual_strain_ratio: strain where the stress has come back to a
/// twentieth of its maximum, over the largest strain.
///
/// Source: uniaxial confined compression as in Chung & Ooi 2008, Particulate Science and
///         Technology 26, 83-96.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/experiments/all.hpp"
#include "engine/filling.hpp"
#include "engine/instrument.hpp"
#include "engine/refusal.hpp"
#include "engine/session.hpp"

namespace repose::engine::experiments {

namespace {

struct Compression {
  struct Settings {
    double side;
    double depth;
    double stress;
    double overshoot;
    double speed;
    double time_step;
  };

  static constexpr ExperimentText text{
      .name = "compression",
      .title = "Uniaxial compression",
      .summary = "A bed is squeezed and let go: its stiffness, and how much does not spring back.",
      .procedure =
          "A bed is filled, struck off and pressed by a flat platen at constant speed past "
          "`stress`; then the platen goes back. Stress is that at the base less the bed's weight.",
      .citation = "Chung & Ooi 2008, Particulate Science and Technology 26, 83-96",
  };
  static constexpr std::array fields{
      Field<Settings>{&Settings::side,
                      {.name = "side",
                       .unit = unit::millimetre,
                       .meaning = "side of the square base, periodic both ways",
                       .null_value = 0.06,
                       .lower = 5e-3,
                       .upper = 1.0,
                       .draft = 0.04}},
      Field<Settings>{&Settings::depth,
                      {.name = "depth",
                       .unit = unit::millimetre,
                       .meaning = "height to which the bed is filled",
                       .null_value = 0.07,
                       .lower = 5e-3,
                       .upper = 1.0,
                       .draft = 0.042}},
      Field<Settings>{&Settings::stress,
                      {.name = "stress",
                       .unit = unit::kilopascal,
                       .meaning = "stress up to which the secant is laid",
                       .null_value = 20e3,
                       .lower = 10.0,
                       .upper = 1e7}},
      Field<Settings>{&Settings::overshoot,
                      {.name = "overshoot",
                       .unit = unit::one,
                       .meaning = "largest stress over `stress`",
                       .null_value = 1.5,
                       .lower = 1.05,
                       .upper = 10.0}},
      Field<Settings>{&Settings::speed,
                      {.name = "speed",
                       .unit = unit::millimetre_per_second,
                       .meaning = "speed of the platen",
                       .null_value = 0.01,
                       .lower = 1e-5,
                       .upper = 0.2}},
      // Pressed grains have many stiff contacts each: at 0.25 the bed trembles and reads 17 % too
      // soft, at 0.3 it reads 41 % too soft (reference grain; 0.05 to 0.2 agree within scatter).
      Field<Settings>{&Settings::time_step,
                      {.name = "time_step",
                       .unit = unit::one,
                       .meaning = "time step over the Rayleigh time of the smallest grain",
                       .null_value = 0.2,
                       .lower = 0.01,
                       .upper = 0.2}},
  };
  static constexpr std::array observables{
      ObservableInfo{"secant_modulus",
                     unit::megapascal,
                     "stress over strain between a quarter of `stress` and `stress`, loading",
                     0.04},
      ObservableInfo{"residual_strain_ratio",
                     unit::one,
                     "strain left at a twentieth of the largest stress over the largest strain",
                     0.05},
  };

  static std::string refuse(const Settings& s, double largest_grain_diameter);
  static Readings run(const Settings& s, Session& session);
};

constexpr std::size_t base = 0, platen = 1;  // among the walls

/// What the press has recorded.
struct Curve {
  std::vector<double> height;  ///< of the platen, m
  std::vector<double> stress;  ///< at the base less the bed's weight, Pa
};

constexpr double way_between_samples = 5e-6;  // m, of the platen

/// Presses or lets go until the condition holds; false where the session failed.
class Press {
 public:
  Press(const Compression::Settings& s, Session& session)
      : session_(session),
        area_(s.side * s.side),
        weight_(9.81 * mass_where(session.world(), [](const Vec3&) { return true; })) {}

  template <class Condition>
  bool move(double speed, double limit, const Condition& done, const std::string& complaint) {
    session_.world().drive(platen, {0.0, 0.0, speed});
    curve = {};
    const auto look = [&] {
      curve.height.push_back(session_.world().surfaces()[platen].from_z);
      const double raw = (-session_.world().wall_loads()[base].force.z - weight_) / area_;
      raw_.push_back(raw);
      constexpr std::size_t smooth = 8;  // samples
      const std::size_t n = std::min(smooth, raw_.size());
      double sum = 0.0;
      for (std::size_t k = raw_.size() - n; k < raw_.size(); ++k) sum += raw_[k];
      curve.stress.push_back(sum / static_cast<double>(n));
      return done(curve.stress.back(), curve.height.back());
    };
    const double watch = way_between_samples / std::abs(speed);
    return session_.until(look, watch, limit, FailureKind::not_observed, complaint);
  }

  Curve curve;

 private:
  Session& session_;
  double area_, weight_;
  std::vector<double> raw_;
};

/// Height of the platen where the stress first passes a level, rising (from below it) or falling;
/// nothing where it does not.
std::optional<double> height_at(const Curve& curve, double level, bool rising) {
  for (std::size_t k = 1; k < curve.stress.size(); ++k) {
    const double before = curve.stress[k - 1], after = curve.stress[k];
    if (rising ? before >= level || after < level : before <= level || after > level) continue;
    return crossing(curve.height[k - 1], curve.height[k], before, after, level);
  }
  return std::nullopt;
}

std::string Compression::refuse(const Settings& s, double largest_grain_diameter) {
  return too_short({{"side", s.side, 5.0}, {"depth", s.depth, 5.0}}, largest_grain_diameter);
}

Readings Compression::run(const Settings& s, Session& session) {
  const double tall = 20.0 * s.depth;
  if (!session.set_up({.walls = {plane(0.0), plane(2.0 * tall)},
                       .period = {s.side, s.side, 0.0},
                       .low = {-1e3, -1e3, -s.depth},
                       .high = {1e3, 1e3, tall},
                       .time_step_share = s.time_step,
                       .fastest = std::sqrt(2.0 * 9.81 * 4.0 * s.depth),
                       .closed = true})) {
    return {};
  }
  const Rain order{.high_x = s.side, .high_y = s.side};
  if (!fill_to(session, order, s.side * s.side * s.depth, s.depth)) return {};
  session.stage("filled");

  World& world = session.world();
  double top = 0.0;
  for (const GrainRow& g : world.grains().rows) top = std::max(top, g.z + g.radius);
  world.change_surfaces()[platen] = plane(top);
  if (!session.run_for(world.time_step())) return {};
  Press press(s, session);
  const double most = s.overshoot * s.stress;
  constexpr double flattest = 0.5;  // of the depth: then it is no bed any more
  if (!press.move(
          -s.speed,
          flattest * top / s.speed,
          [most](double stress, double) { return stress >= most; },
          "the stress did not reach " + quantity_text(most, unit::kilopascal) +
              " before the bed was half as deep: the grains are too soft for `stress`")) {
    return {};
  }
  session.stage("pressed");
  const Curve loading = press.curve;
  const double left = 0.05 * most;
  if (!press.move(
          s.speed,
          top / s.speed,
          [left](double stress, double) { return stress <= 0.5 * left; },
          "the stress did not fall while the platen went back")) {
    return {};
  }
  session.stage("released");

  const auto depth = height_at(loading, 0.01 * s.stress, true);
  const auto start = height_at(loading, left, true);
  const auto quarter = height_at(loading, 0.25 * s.stress, true);
  const auto full = height_at(loading, s.stress, true);
  const auto end = height_at(press.curve, left, false);
  if (!depth || !start || !quarter || !full || !end || *quarter <= *full) {
    session.fail(FailureKind::not_observed,
                 "the stress does not rise steadily with the platen's way: `stress` is too small "
                 "beside the bed's own weight and trembling");
    return {};
  }
  const double largest = *start - loading.height.back();
  return std::vector<Reading>{0.75 * s.stress * *depth / (*quarter - *full),
                              (*start - *end) / largest};
}

constexpr auto settings = with_conditions(Compression::fields);

}  // namespace

constinit const ExperimentInfo compression =
    describe<Compression>(settings, refusal<Compression>, conduct<Compression>);

}  // namespace repose::engine::experiments
