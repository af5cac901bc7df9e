#include "engine/effects/jkr_adhesion.hpp"

#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "tests/engine/verification/impact.hpp"
#include "tests/engine/verification/table.hpp"
#include "tests/support/one_contact.hpp"

using namespace repose::engine;
using namespace repose::tests;

namespace {

constexpr double work = 0.5;  // J/m2

ParameterSet sticky(double w, double sliding = 0.0) {
  ParameterSet set = parameters({.sliding = sliding});
  set_pairs(set, "jkr_adhesion.work", w);
  return set;
}

/// A contact of the reference grain with a grain or a wall, and its scales.
struct Stuck {
  OneContact contact;
  double r, modulus, pull_off, let_go;

  explicit Stuck(double radius_j)
      : contact(sticky(work), 3e-3, radius_j),
        r(contact.reduced_radius()),
        modulus(contact.elastic().modulus),
        pull_off(1.5 * unit::pi * work * r),
        let_go(-0.75 * std::cbrt(unit::pi * unit::pi * work * work * r / (modulus * modulus))) {
    contact.push({.overlap = 1e-6});
  }
  /// Force and overlap of the law at a patch radius.
  [[nodiscard]] double overlap(double a) const {
    return a * a / r - std::sqrt(2.0 * unit::pi * work * a / modulus);
  }
  [[nodiscard]] double force(double a) const {
    const double cube = a * a * a;
    return 4.0 * modulus * cube / (3.0 * r) - std::sqrt(8.0 * unit::pi * work * modulus * cube);
  }
};

double rebound(double speed) {
  ParameterSet set;
  set_pairs(set, "jkr_adhesion.work", work);
  return collide({.law = {}, .effects = set, .normal = speed, .steps = 4000}).normal / speed;
}

/// How far from a wall a grain that met it with a speed gets in twenty collision times, m.
double farthest_after(double speed) {
  const GrainLaw law;
  ParameterSet set = parameters(law);
  set_pairs(set, "jkr_adhesion.work", work);
  World world(ContactModel(set), {.time_step = 1e-6, .period = {}, .gravity = {}});
  world.change_surfaces().push_back(plane(0.0));
  GrainRow grain = sphere(0.5 * law.diameter, law.density);
  grain.z = grain.radius * (1.0 + 1e-9);
  grain.vz = -speed;
  world.add(grain);
  double farthest = 0.0;
  for (int i = 0; i < 60000; ++i) {
    world.step();
    farthest = std::max(farthest, world.grains().rows[0].z - grain.radius);
  }
  return farthest;
}

}  // namespace

TEST_CASE("the JKR curve is followed in approach and in parting", "[engine][verification]") {
  for (const double radius_j : {3e-3, 1e-3, 0.0}) {
    Stuck s(radius_j);
    const double least =
        std::cbrt(unit::pi * work * s.r * s.r / (8.0 * s.modulus));  // patch at letting go
    double worst = 0.0;
    for (double share = 6.0; share > 1.001; share *= 0.98) {
      const double a = least * share;
      const double got = s.contact.force({.overlap = s.overlap(a)});
      worst = std::max(worst, std::abs(got - s.force(a)) / s.pull_off);
    }
    verify("JKR curve, largest error over the pull-off", 0.0, worst, absolute(1e-6));
  }
}

TEST_CASE("JKR pull-off, force at touch and letting go are those of the theory",
          "[engine][verification]") {
  Stuck s(0.0);
  verify("JKR, force at touch over pull-off",
         -8.0 / 9.0,
         s.contact.force({.overlap = 0.0}) / s.pull_off,
         absolute(1e-6));
  double strongest = 0.0, last = 0.0, d = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double force = s.contact.force({.overlap = d});
    if (force == 0.0) break;
    strongest = std::min(strongest, force);
    last = force;
    d += 1e-4 * s.let_go;
  }
  verify("JKR, strongest pull over 3/2 pi w R*", -1.0, strongest / s.pull_off, absolute(1e-6));
  verify("JKR, overlap at letting go, m", s.let_go, d, relative(2e-4));
  verify("JKR, force at letting go over pull-off", -5.0 / 9.0, last / s.pull_off, absolute(0.02));
  CHECK(s.contact.force({.overlap = 0.5 * s.let_go}) == 0.0);  // parted: no force until touch
  CHECK(s.contact.force({.overlap = 1e-9}) < 0.0);
}

TEST_CASE("slow collisions stick and faster ones lose the work of the neck",
          "[engine][verification]") {
  const GrainLaw law;
  Stuck s(0.0);
  const double r = 0.5 * law.diameter;
  const double m = mass(sphere(r, law.density));
  const double bond = 7.09 * std::cbrt(std::pow(work, 5.0) * std::pow(r, 4.0) /
                                       (s.modulus * s.modulus));  // Thornton & Ning 1998, J
  const double sticking = std::sqrt(2.0 * bond / m);
  CHECK(farthest_after(0.95 * sticking) < -1.01 * s.let_go);
  CHECK(farthest_after(1.05 * sticking) > -10.0 * s.let_go);
  for (const double times : {1.1, 1.5, 3.0}) {
    verify("JKR rebound at " + std::to_string(times).substr(0, 3) + " sticking speeds",
           std::sqrt(1.0 - 1.0 / (times * times)),
           rebound(times * sticking),
           absolute(0.01));
  }
}

TEST_CASE("under JKR adhesion friction leans on the force and twice the pull-off", "[engine]") {
  OneContact contact(sticky(work, 0.4), 3e-3, 0.0);
  const ContactBlock& c = contact.push({.overlap = 1e-4, .slip = 1.0}, 1.0);
  const double lean = c.normal_force[0] + 3.0 * unit::pi * work * contact.reduced_radius();
  CHECK(c.grip_force[0] == Approx(lean));
  CHECK(std::abs(c.tangent_x[0]) == Approx(0.4 * lean));
}

TEST_CASE("without work of adhesion the force is Hertz's, to the last bit", "[engine]") {
  OneContact off(sticky(0.0), 3e-3, 0.0), bare(parameters({}), 3e-3, 0.0);
  CHECK(off.force({.overlap = 1e-4}) == bare.force({.overlap = 1e-4}));
}
