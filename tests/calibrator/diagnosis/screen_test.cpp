#include "calibrator/diagnosis/screen.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include <Eigen/QR>
#include <catch2/catch.hpp>

#include "calibrator/diagnosis/chi_squared.hpp"
#include "calibrator/diagnosis/verdict.hpp"
#include "engine/random.hpp"

using namespace repose::calibrator;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// f = A x over four targets and one parameter, fitted to y.
struct Fitted {
  ModelSpace space;
  ModelFit fit;
};

Fitted fitted(const MatrixXd& slopes, const VectorXd& y) {
  const auto d = slopes.cols();
  const ModelSpace space{VectorXd::Constant(d, -10.0),
                         VectorXd::Constant(d, 10.0),
                         VectorXd::Zero(d),
                         VectorXd::Constant(d, 1e-6)};
  const Predictor predictor{[&](const VectorXd& x) -> VectorXd { return slopes * x; },
                            [&](const VectorXd&) -> MatrixXd { return slopes; }};
  const std::vector<VectorXd> starts{VectorXd::Zero(d)};
  return {space, fit_model(predictor, y, MatrixXd::Identity(y.size(), y.size()), space, starts)};
}

}  // namespace

TEST_CASE("a linear model is fitted by least squares", "[calibrator]") {
  const MatrixXd slopes = (MatrixXd(4, 2) << 1, 0, 0, 1, 1, 1, 1, -1).finished();
  const VectorXd y = (VectorXd(4) << 1, 2, 4, 0).finished();
  const Fitted model = fitted(slopes, y);
  const VectorXd expected = slopes.colPivHouseholderQr().solve(y);
  CHECK((model.fit.at - expected).norm() < 1e-6);
  CHECK(model.fit.misfit == Approx((y - slopes * expected).squaredNorm()));
  CHECK(model.fit.freedom == Approx(2.0).margin(1e-6));
}

TEST_CASE("a bound holds a parameter and gives its direction back to the data", "[calibrator]") {
  const MatrixXd slopes = (MatrixXd(3, 1) << 1, 1, 1).finished();
  const VectorXd y = VectorXd::Constant(3, 20.0);
  const Fitted model = fitted(slopes, y);
  CHECK(model.fit.at(0) == 10.0);
  CHECK(model.fit.inside.empty());
  CHECK(model.fit.freedom == 3.0);
}

TEST_CASE("a score is what the misfit falls by where the model is linear", "[calibrator]") {
  const MatrixXd slopes = (MatrixXd(4, 1) << 1, 1, 1, 1).finished();
  const VectorXd effect = (VectorXd(4) << 0, 1, 2, 3).finished();
  const VectorXd y = slopes * VectorXd::Constant(1, 2.0) + 0.7 * effect +
                     (VectorXd(4) << 0.1, -0.2, 0.15, 0.05).finished();
  const Fitted base = fitted(slopes, y);
  const Screen screen(base.fit, base.space, {{effect, false}});
  MatrixXd both(4, 2);
  both << slopes, effect;
  const Fitted full = fitted(both, y);
  CHECK(screen.scores()[0].strength == Approx(full.fit.at(1)).margin(1e-6));
  CHECK(screen.scores()[0].value == Approx(base.fit.misfit - full.fit.misfit).margin(1e-6));
  CHECK(screen.scores()[0].absorbed == Approx(9.0 / 14.0));  // the mean of 0, 1, 2, 3 is absorbed
}

TEST_CASE("what the parameters imitate leaves no trace, and a strength below zero no score",
          "[calibrator]") {
  const MatrixXd slopes = (MatrixXd(3, 1) << 1, 2, 3).finished();
  const VectorXd other = (VectorXd(3) << 1, 0, 0).finished();
  const VectorXd y = (VectorXd(3) << 1.0 - 2.0, 2.0, 3.0).finished();
  const Fitted base = fitted(slopes, y);
  const Screen screen(
      base.fit, base.space, {{slopes.col(0), false}, {other, false}, {other, true}});
  CHECK(screen.scores()[0].absorbed == Approx(1.0).margin(1e-9));
  CHECK(screen.scores()[0].value == Approx(0.0).margin(1e-9));
  CHECK(screen.scores()[1].value == 0.0);
  CHECK(screen.scores()[2].value > 1.0);
  CHECK(screen.similarity()(1, 2) == Approx(1.0));
}

TEST_CASE("mirror images are one trace only where a strength can fall below zero", "[calibrator]") {
  const MatrixXd slopes = (MatrixXd(3, 1) << 1, 1, 1).finished();
  const VectorXd trace = (VectorXd(3) << -1, 0, 1).finished();
  const Fitted base = fitted(slopes, trace);
  const std::vector<Departure> departures{
      {trace, false}, {2.0 * trace, false}, {-trace, false}, {-trace, true}};
  const Screen screen(base.fit, base.space, departures);
  CHECK(screen.similarity()(0, 2) == Approx(-1.0));
  CHECK(screen.scores()[2].value == 0.0);  // what speaks for the first speaks against it
  CHECK(screen.same_trace(0, 1));
  CHECK_FALSE(screen.same_trace(0, 2));
  CHECK(screen.same_trace(0, 3));

  Diagnosis diagnosis;
  for (int k = 0; k < 3; ++k) {
    diagnosis.effects.emplace_back().status = EffectStatus::excluded;
  }
  find_families(screen, {0, 1, 2}, diagnosis);
  CHECK(diagnosis.families == std::vector<std::vector<std::size_t>>{{0, 1}});
}

TEST_CASE("scatter of the runs behind a trace adds information to it but no power",
          "[calibrator]") {
  const MatrixXd slopes = (MatrixXd(4, 1) << 1, 1, 1, 1).finished();
  const Fitted base = fitted(slopes, VectorXd::Zero(4));
  const VectorXd trace = (VectorXd(4) << 1, -1, 2, -2).finished();
  const VectorXd variance = (VectorXd(4) << 1, 0, 2, 1).finished();
  const Screen screen(base.fit, base.space, {{trace, true}, {trace, true, variance}});
  const Score &clear = screen.scores()[0], &blurred = screen.scores()[1];
  CHECK(power_of(clear) == Approx(10.0).epsilon(1e-4));
  CHECK(blurred.information == Approx(10.0).epsilon(1e-4));
  CHECK(blurred.noise == Approx(0.75 * 4.0).epsilon(1e-4));  // the mean is the parameter's
  CHECK(power_of(blurred) == Approx(4.9).epsilon(1e-4));
  // A trace of nothing but scatter is worth nothing.
  const Screen empty(base.fit, base.space, {{trace, true, 4.0 * variance}});
  CHECK(power_of(empty.scores().front()) == 0.0);
}

TEST_CASE("the joint null exceeds the largest score as often as it says", "[calibrator]") {
  const MatrixXd slopes = (MatrixXd(6, 1) << 1, 1, 1, 1, 1, 1).finished();
  const Fitted base = fitted(slopes, VectorXd::Zero(6));
  std::vector<Departure> departures;
  for (int k = 0; k < 4; ++k) departures.push_back({VectorXd::Unit(6, k), true});
  const Screen screen(base.fit, base.space, departures);
  const double known = std::numeric_limits<double>::infinity();
  const auto null = screen.draw_null(4, VectorXd::Constant(6, known), 1, 20000);
  const auto above =
      std::ranges::count_if(null, [](const Screen::Draw& draw) { return draw.misfit >= 11.0705; });
  CHECK(above == Approx(0.05 * 20000).epsilon(0.15));  // 95 % of chi-squared with five
  const auto estimated = screen.draw_null(4, VectorXd::Constant(6, 4.0), 1, 20000);
  const auto wider = std::ranges::count_if(
      estimated, [](const Screen::Draw& draw) { return draw.misfit >= 11.0705; });
  CHECK(wider > 3 * above);  // what is estimated from five repetitions is no proof
}

TEST_CASE("the joint null is that of the scores, weak departures held to their limits included",
          "[calibrator]") {
  constexpr std::size_t named = 7;
  const MatrixXd slopes = MatrixXd::Ones(12, 1);
  std::vector<Departure> departures{{2.0 * VectorXd::Unit(12, 0), false}};
  constexpr double weak = 0.2;  // its strength would often be far beyond its limit
  for (int k = 1; k < 7; ++k) departures.push_back({weak * VectorXd::Unit(12, k), false});
  for (int k = 7; k < 9; ++k) departures.push_back({2.0 * VectorXd::Unit(12, k), true});
  const VectorXd known = VectorXd::Constant(12, std::numeric_limits<double>::infinity());
  const Fitted base = fitted(slopes, VectorXd::Zero(12));
  const auto null = Screen(base.fit, base.space, departures).draw_null(named, known, 1, 20000);

  constexpr int studies = 1000;
  int low_named = 0, low_unnamed = 0;
  for (std::uint64_t seed = 1; seed <= studies; ++seed) {
    repose::engine::Random random(seed, repose::engine::Purpose::trial);
    VectorXd y(12);
    for (double& value : y) value = random.normal();
    const Fitted model = fitted(slopes, y);
    const Screen screen(model.fit, model.space, departures);
    double largest = 0.0, largest_unnamed = 0.0;
    for (std::size_t k = 0; k < departures.size(); ++k) {
      double& own = k < named ? largest : largest_unnamed;
      own = std::max(own, screen.scores()[k].value);
    }
    low_named += share_at_least(null, &Screen::Draw::named, largest) < 0.05 ? 1 : 0;
    low_unnamed += share_at_least(null, &Screen::Draw::unnamed, largest_unnamed) < 0.05 ? 1 : 0;
  }
  CHECK(low_named == Approx(0.05 * studies).margin(21));  // three standard deviations
  CHECK(low_unnamed == Approx(0.05 * studies).margin(21));
}

TEST_CASE("the chi-squared tail meets its table", "[calibrator]") {
  CHECK(chi_squared_tail(3.841458820694124, 1.0) == Approx(0.05));
  CHECK(chi_squared_tail(18.30703805327515, 10.0) == Approx(0.05));
  CHECK(chi_squared_tail(5.0, 0.0) == 1.0);
  CHECK(chi_squared_tail(0.0, 3.0) == 1.0);
}
