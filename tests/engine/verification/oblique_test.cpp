// Which tangential law each curve of the impact benchmark is of. Where a sphere sticks its rebound
// is set by the stiffness of the spring: that which fits a curve best says whose law it was.
// Curves: Chung & Ooi 2011, Granular Matter 13, 643-656, digitised.
#include "tests/engine/verification/oblique.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "engine/effects/restitution.hpp"
#include "engine/unit.hpp"
#include "tests/engine/verification/table.hpp"

using namespace repose::tests;
using repose::engine::effects::damping_number;
using Spring = TangentialLaw::Spring;

namespace {

struct Point {
  double slip;   ///< before, over mu Vn
  double ratio;  ///< slip after over slip before
};

struct Curve {
  std::string name;
  ObliqueImpact impact;
  std::vector<Point> points;
};

/// Test 4: angle from the normal in degrees, tangential restitution.
Curve test_4() {
  Curve curve{"4 aluminium oxide", {0.092, 0.23, damping_number(0.98), 0.0}, {}};
  const double table[][2] = {
      {5, 0.948}, {10, 0.687}, {15, 0.624}, {20, 0.616}, {25, 0.634}, {30, 0.684}};
  for (const auto& row : table) {
    const double slip = std::tan(row[0] * repose::engine::unit::pi / 180) / curve.impact.sliding;
    curve.points.push_back({slip, 1.0 - 3.5 * (1.0 - row[1])});
  }
  return curve;
}

/// Test 5: slip before and after, over mu Vn.
Curve test_5(const std::string& name, double poisson, const std::vector<Point>& table) {
  Curve curve{"5 " + name, {0.3, poisson, 0.0, 0.0}, {}};
  for (const auto& [before, after] : table) curve.points.push_back({before, after / before});
  return curve;
}

Curve steel() {
  return test_5("steel",
                0.30,
                {{0.35, -0.28},
                 {0.68, -0.493},
                 {1.0, -0.747},
                 {1.34, -1.0},
                 {1.67, -1.267},
                 {2.0, -1.533},
                 {2.34, -1.813},
                 {2.99, -2.44},
                 {3.33, -2.693},
                 {4.0, -2.787}});
}

Curve polyethylene() {
  return test_5("polyethylene",
                0.40,
                {{1.0, -0.88}, {2.0, -1.76}, {3.0, -2.68}, {3.34, -2.947}, {4.0, -2.933}});
}

/// Wu's finite elements.
Curve elements() {
  return test_5("finite elements",
                0.30,
                {{1.19, -0.213},
                 {1.53, -0.373},
                 {1.9, -0.627},
                 {2.3, -0.947},
                 {2.78, -1.253},
                 {3.31, -1.52},
                 {3.95, -1.72},
                 {4.75, -1.707},
                 {5.7, -1.2}});
}

/// Test 6: s = (7/2) mu (1 + e) Vn / Vst and beta, less the slip's ratio.
Curve test_6() {
  Curve curve{"6 aluminium alloy", {0.4, 0.33, damping_number(0.5), 0.0}, {}};
  const double table[][2] = {{1.214, 0.096},
                             {1.492, 0.111},
                             {1.77, 0.090},
                             {2.09, 0.058},
                             {2.52, 0.006},
                             {2.99, -0.049},
                             {3.63, -0.103},
                             {4.51, -0.139},
                             {5.77, -0.162},
                             {7.84, -0.204},
                             {11.9, -0.259},
                             {24, -0.339}};
  for (const auto& row : table) curve.points.push_back({3.5 * 1.5 / row[0], -row[1]});
  return curve;
}

/// Root mean square of what is left between the slip ratios of a curve and of a law.
double left_over(const Curve& curve, const TangentialLaw& law) {
  double sum = 0.0;
  for (const Point& point : curve.points) {
    ObliqueImpact impact = curve.impact;
    impact.slip = point.slip;
    sum += std::pow(slip_ratio(impact, law) - point.ratio, 2.0);
  }
  return std::sqrt(sum / static_cast<double>(curve.points.size()));
}

struct Fit {
  TangentialLaw law;
  double left = std::numeric_limits<double>::max();
};

/// The law that fits best, of stiffnesses from a third to double Mindlin's and these dashpots.
Fit best_fit(const Curve& curve, Spring spring, const std::vector<double>& dashpots) {
  Fit best;
  for (double stiffness = 0.30; stiffness < 2.0; stiffness += 0.02) {
    for (const double damping : dashpots) {
      const TangentialLaw law{spring, stiffness, damping};
      if (const double left = left_over(curve, law); left < best.left) best = {law, left};
    }
  }
  return best;
}

}  // namespace

TEST_CASE("the curve of Chung & Ooi 4 is that of Mindlin's stiffness", "[engine][verification]") {
  const Fit fit = best_fit(test_4(), Spring::displacement, {1.0});
  verify("4, stiffness over 8 G* a", 1.0, fit.law.stiffness, absolute(0.05));
  verify("4, slip's ratio, left over", 0.0, fit.left, absolute(0.03));
}

TEST_CASE("the curves of Chung & Ooi 5 are those of half the stiffness, the force added up",
          "[engine][verification]") {
  for (const Curve& curve : {steel(), polyethylene()}) {
    const Fit fit = best_fit(curve, Spring::increments, {1.0});
    verify(curve.name + ", stiffness over 8 G* a", 0.48, fit.law.stiffness, absolute(0.03));
    verify(curve.name + ", slip's ratio, left over", 0.0, fit.left, absolute(0.04));
    CHECK(left_over(curve, {}) > 10.0 * fit.left);  // the engine's law
  }
  const Fit fit = best_fit(elements(), Spring::displacement, {1.0});
  report("5 finite elements, stiffness over 8 G* a", 1.0, fit.law.stiffness);
}

TEST_CASE("the curve of Chung & Ooi 6 is of no law that fits the others",
          "[engine][verification]") {
  const std::vector<double> dashpots{0.0, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0};
  const Fit fit = best_fit(test_6(), Spring::displacement, dashpots);
  verify("6, stiffness over 8 G* a", 1.3, fit.law.stiffness, absolute(0.1));
  report("6, dashpot over the engine's", 1.0, fit.law.damping);
  report("6, slip's ratio, left over", 0.0, fit.left);
  CHECK(left_over(test_6(), {.stiffness = 0.48}) > 5.0 * fit.left);
}
