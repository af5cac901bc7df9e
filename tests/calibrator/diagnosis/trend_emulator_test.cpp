#include "calibrator/diagnosis/trend_emulator.hpp"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "engine/random.hpp"

using Eigen::Index;
using repose::calibrator::TrendEmulator;

namespace {

struct Runs {
  Eigen::MatrixXd inputs, outputs;
};

/// A plane, a curve, and the curve with scatter, over the unit square.
Runs runs(Index count) {
  repose::engine::Random random(3, repose::engine::Purpose::design);
  Runs runs{Eigen::MatrixXd(count, 2), Eigen::MatrixXd(count, 3)};
  for (Index i = 0; i < count; ++i) {
    const double a = random.uniform(), b = random.uniform();
    runs.inputs.row(i) << a, b;
    const double curve = std::sin(3.0 * a) + a * b;
    runs.outputs.row(i) << 2.0 + 3.0 * a - b, curve, curve + 0.1 * random.normal();
  }
  return runs;
}

}  // namespace

TEST_CASE("a trend emulator reproduces planes exactly and curves closely", "[calibrator]") {
  const Runs r = runs(60);
  const TrendEmulator emulator(r.inputs, r.outputs, Eigen::Vector2d::Ones());
  const Eigen::Vector2d x(0.4, 0.7);
  const Eigen::VectorXd mean = emulator.mean(x);
  CHECK(mean(0) == Approx(2.0 + 1.2 - 0.7).margin(1e-6));
  CHECK(mean(1) == Approx(std::sin(1.2) + 0.28).margin(0.01));
  CHECK(std::abs(mean(2) - std::sin(1.2) - 0.28) < 0.1);
  CHECK(emulator.noise()(2) == Approx(0.01).epsilon(0.6));
  CHECK(emulator.variance(x)(2) < 0.01);
  CHECK(emulator.variance(Eigen::Vector2d(3.0, 3.0))(1) > emulator.variance(x)(1));
}

TEST_CASE("a trend emulator's slopes are those of its mean", "[calibrator]") {
  const Runs r = runs(40);
  const TrendEmulator emulator(r.inputs, r.outputs, Eigen::Vector2d(1.0, 1.3));
  const Eigen::Vector2d x(0.3, 0.6);
  const Eigen::MatrixXd slopes = emulator.jacobian(x);
  constexpr double step = 1e-5;
  for (Index k = 0; k < 2; ++k) {
    Eigen::Vector2d right = x, left = x;
    right(k) += step;
    left(k) -= step;
    const Eigen::VectorXd expected = (emulator.mean(right) - emulator.mean(left)) / (2.0 * step);
    for (Index j = 0; j < 3; ++j) CHECK(slopes(j, k) == Approx(expected(j)).margin(1e-5));
  }
}

TEST_CASE("an output that few runs observed is unknown, and others keep all their runs",
          "[calibrator]") {
  Runs r = runs(30);
  const Eigen::Vector2d x(0.5, 0.5);
  const double before = TrendEmulator(r.inputs, r.outputs, Eigen::Vector2d::Ones()).mean(x)(0);
  for (Index i = 4; i < 30; ++i) r.outputs(i, 2) = std::numeric_limits<double>::quiet_NaN();
  const TrendEmulator emulator(r.inputs, r.outputs, Eigen::Vector2d::Ones());
  CHECK_FALSE(emulator.knows(2));
  CHECK(std::isnan(emulator.mean(x)(2)));
  CHECK(emulator.knows(0));
  CHECK(emulator.mean(x)(0) == Approx(before).margin(1e-9));
}

TEST_CASE("an output that does not depend on an input is the same at all its values",
          "[calibrator]") {
  const Runs r = runs(40);
  const TrendEmulator::Heard heard{{0, 1}, {0}, {0, 1}};
  const TrendEmulator emulator(r.inputs, r.outputs, Eigen::Vector2d::Ones(), heard);
  const Eigen::Vector2d here(0.4, 0.2), there(0.4, 0.9);
  CHECK(emulator.mean(here)(1) == emulator.mean(there)(1));
  CHECK(emulator.variance(here)(1) == emulator.variance(there)(1));
  CHECK(emulator.jacobian(here)(1, 1) == 0.0);
  CHECK(std::abs(emulator.mean(here)(0) - emulator.mean(there)(0)) == Approx(0.7).margin(1e-6));
}
