#include "calibrator/diagnosis/chance.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "calibrator/diagnosis/chi_squared.hpp"
#include "calibrator/diagnosis/covariance.hpp"

using namespace repose;
using namespace repose::calibrator;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr int repetitions = 5;

/// A right model of one parameter, fitted to twelve targets whose errors were read from a few
/// repetitions each.
struct RightModel {
  ModelSpace space;
  ModelFit fit;
};

RightModel right_model(std::uint64_t seed) {
  constexpr Index count = 12;
  engine::Random random(seed, engine::Purpose::trial);
  VectorXd y(count), variance(count);
  for (Index j = 0; j < count; ++j) {
    y(j) = random.normal();
    variance(j) = 0.0;
    for (int r = 1; r < repetitions; ++r) {
      variance(j) += std::pow(random.normal(), 2) / (repetitions - 1);
    }
  }
  const ModelSpace space{VectorXd::Constant(1, -10.0),
                         VectorXd::Constant(1, 10.0),
                         VectorXd::Zero(1),
                         VectorXd::Constant(1, 1e-6)};
  const MatrixXd slopes = MatrixXd::Ones(count, 1);
  const Predictor predictor{[&](const VectorXd& x) -> VectorXd { return slopes * x; },
                            [&](const VectorXd&) -> MatrixXd { return slopes; }};
  const std::vector<VectorXd> starts{VectorXd::Zero(1)};
  return {space, fit_model(predictor, y, variance.asDiagonal(), space, starts)};
}

}  // namespace

TEST_CASE("a right model's misfit is as improbable as it is rare, its errors estimated",
          "[calibrator]") {
  constexpr int models = 200;
  const VectorXd freedom = VectorXd::Constant(12, repetitions - 1.0);
  int told = 0, counted = 0, taken_for_known = 0;
  for (std::uint64_t seed = 1; seed <= models; ++seed) {
    const RightModel model = right_model(seed);
    told += misfit_p(model.fit, model.space, freedom, seed) < 0.2 ? 1 : 0;
    counted += misfit_p(model.fit.misfit, 1, freedom, seed) < 0.2 ? 1 : 0;
    taken_for_known += chi_squared_tail(model.fit.misfit, model.fit.freedom) < 0.2 ? 1 : 0;
  }
  CHECK(told == Approx(0.2 * models).margin(18));  // three standard deviations
  CHECK(counted == Approx(0.2 * models).margin(18));
  CHECK(taken_for_known > 80);
}

TEST_CASE("where every error is known a misfit is chi-squared", "[calibrator]") {
  const RightModel model = right_model(1);
  const VectorXd known = VectorXd::Constant(12, std::numeric_limits<double>::infinity());
  CHECK(misfit_p(model.fit, model.space, known, 1) ==
        chi_squared_tail(model.fit.misfit, model.fit.freedom));
  CHECK(misfit_p(20.0, 2, known, 1) == chi_squared_tail(20.0, 10.0));
  CHECK(misfit_p(20.0, 12, VectorXd::Constant(12, 4.0), 1) == 1.0);  // nothing is left to test
}

TEST_CASE("of a variance that is mostly tolerance most is known", "[calibrator]") {
  std::vector<Measurement> measurements(3);
  for (Measurement& measurement : measurements) {
    measurement.standard_error = 0.01;
    measurement.replicates = 3;
  }
  measurements[2].replicates = 0;
  const VectorXd variance = (VectorXd(3) << 1e-4, 1e-4 + 9e-4, 1e-4).finished();
  const VectorXd freedom = freedom_of(measurements, variance);
  CHECK(freedom(0) == Approx(2.0));
  CHECK(freedom(1) == Approx(200.0));
  CHECK(std::isinf(freedom(2)));
}
