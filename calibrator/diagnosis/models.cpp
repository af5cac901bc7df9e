#include "calibrator/diagnosis/models.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <Eigen/Cholesky>

#include "calibrator/design.hpp"
#include "calibrator/diagnosis/chance.hpp"
#include "calibrator/diagnosis/screen.hpp"

namespace repose::calibrator {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double prior_deviation = 0.6;     // of a free parameter, about the middle of its range
constexpr double strength_deviation = 1.5;  // of a strength, about zero
constexpr std::uint64_t starts_design = 1'000'000;  // apart from other designs
constexpr double threshold = 3.84;  // 95 % of chi-squared with one degree of freedom

/// What data and prior know of the parameters: the inverse of their covariance.
Matrix curvature_of(const Model& model) {
  Matrix curvature = model.fit.jacobian.transpose() * model.fit.jacobian;
  curvature.diagonal() += model.space.precision.cwiseAbs2();
  return curvature;
}

}  // namespace

std::vector<Vector> draws_of(const Model& model, int count, engine::Random& random) {
  const Eigen::LLT<Matrix> root(curvature_of(model));
  std::vector<Vector> result{model.fit.at};
  for (int n = 1; n < count; ++n) {
    Vector z(model.fit.at.size());
    for (double& value : z) value = random.normal();
    const Vector x = model.fit.at + root.matrixU().solve(z);
    result.push_back(x.cwiseMax(model.space.lower).cwiseMin(model.space.upper));
  }
  return result;
}

Models::Models(const DiagnosisQuestion& question, const SuiteRuns& runs)
    : question_(question), runs_(runs) {
  const TrendEmulator emulator = learn({});
  const auto& measurements = question.calibration.measurements;
  for (std::size_t j = 0; j < measurements.size(); ++j) {
    const auto index = static_cast<Index>(j);
    if (measurements[j].role == Role::fit && emulator.knows(index)) fitted_.push_back(index);
  }
  targets_.resize(static_cast<Index>(fitted_.size()));
  for (Index i = 0; i < targets_.size(); ++i) {
    const auto j = static_cast<std::size_t>(fitted_[static_cast<std::size_t>(i)]);
    // Targets are at the fidelity of the search.
    targets_(i) = measurements[j].value - question.offset(static_cast<Index>(j));
  }
}

TrendEmulator Models::learn(const Additions& on) const {
  const SuiteRuns::Table table = runs_.table(on);
  Vector scale = Vector::Ones(table.inputs.cols());
  scale.tail(static_cast<Index>(on.size())).setConstant(largest_strength);
  return {table.inputs, table.outputs, std::move(scale), table.heard};
}

Predictor Models::predictor(const TrendEmulator& emulator) const {
  return {[this, &emulator](const Vector& x) -> Vector { return emulator.mean(x)(fitted_); },
          [this, &emulator](const Vector& x) -> Matrix {
            return emulator.jacobian(x)(fitted_, Eigen::all);
          }};
}

Matrix Models::covariance(const TrendEmulator& emulator, const Vector& at) const {
  Matrix result = question_.covariance(fitted_, fitted_);
  result.diagonal() += emulator.variance(at)(fitted_);
  return result;
}

ModelSpace Models::space(const Additions& on) const {
  const auto d = static_cast<Index>(runs_.space().dimensions());
  const Index all = d + static_cast<Index>(on.size());
  ModelSpace space{Vector::Zero(all),
                   Vector::Ones(all),
                   Vector::Constant(all, 0.5),
                   Vector::Constant(all, 1.0 / prior_deviation)};
  for (Index k = d; k < all; ++k) {
    const bool two_sided = question_.suspects[on[static_cast<std::size_t>(k - d)]].two_sided;
    space.lower(k) = two_sided ? -largest_strength : 0.0;
    space.upper(k) = largest_strength;
    space.centre(k) = 0.0;
    space.precision(k) = 1.0 / strength_deviation;
  }
  return space;
}

double Models::misfit_p(const ModelFit& fit, const ModelSpace& space) const {
  return calibrator::misfit_p(
      fit, space, question_.error_freedom(fitted_), question_.calibration.seed);
}

bool Models::knows_all_fitted() const {
  return std::cmp_equal(
      fitted_.size(),
      std::ranges::count(question_.calibration.measurements, Role::fit, &Measurement::role));
}

Model Models::fit_calibrated() const {
  const std::size_t dimensions = runs_.space().dimensions();
  const auto vector_of = [&](const UnitPoint& u) -> Vector {
    return Eigen::Map<const Vector>(u.data(), static_cast<Index>(u.size()));
  };
  std::vector<Vector> starts{vector_of(runs_.space().coordinates(question_.fit.best)),
                             Vector::Constant(static_cast<Index>(dimensions), 0.5)};
  for (const UnitPoint& u :
       latin_hypercube(4, dimensions, question_.calibration.seed, starts_design)) {
    starts.push_back(vector_of(u));
  }
  return fit({}, starts);
}

double Models::held_out_p(const Model& model) const {
  const Vector& at = model.fit.at;
  const auto& measurements = question_.calibration.measurements;
  const Vector predicted = model.emulator.mean(at);
  std::vector<Index> held;
  std::vector<double> gaps;
  for (std::size_t j = 0; j < measurements.size(); ++j) {
    const auto index = static_cast<Index>(j);
    if (!held_out(measurements[j]) || !model.emulator.knows(index)) continue;
    held.push_back(index);
    gaps.push_back(measurements[j].value - question_.offset(index) - predicted(index));
  }
  if (held.empty()) return 1.0;
  Matrix covariance = question_.covariance(held, held);
  covariance.diagonal() += model.emulator.variance(at)(held);
  const Matrix slopes = model.emulator.jacobian(at)(held, Eigen::all);
  covariance += slopes * curvature_of(model).llt().solve(slopes.transpose());
  const auto gap = Eigen::Map<const Vector>(gaps.data(), std::ssize(gaps));
  return calibrator::misfit_p(gap.dot(covariance.llt().solve(gap)),
                              0,
                              question_.error_freedom(held),
                              question_.calibration.seed);
}

Model Models::fit(const Additions& on, std::span<const Vector> starts) const {
  Model model{on, learn(on), space(on), {}};
  const Predictor predictor = this->predictor(model.emulator);
  model.fit = fit_model(
      predictor, targets_, covariance(model.emulator, starts.front()), model.space, starts);
  // The emulator's own uncertainty is the one where the model came to lie.
  const std::vector<Vector> again{model.fit.at};
  model.fit =
      fit_model(predictor, targets_, covariance(model.emulator, model.fit.at), model.space, again);
  return model;
}

/// A grid, each point started from its neighbour's solution.
Models::Range Models::strength_range(const Model& model) const {
  constexpr int steps = 27;
  const auto k = static_cast<Index>(runs_.space().dimensions());
  const double lower = model.space.lower(k), upper = model.space.upper(k);
  const double step = (upper - lower) / (steps - 1);
  const Predictor predictor = this->predictor(model.emulator);
  std::vector<double> deviance(steps);
  const int middle =
      std::clamp(static_cast<int>(std::lround((model.fit.at(k) - lower) / step)), 0, steps - 1);
  const auto walk = [&](int from, int to, int direction) {
    Vector x = model.fit.at;
    for (int i = from; i != to; i += direction) {
      ModelSpace held = model.space;
      held.lower(k) = held.upper(k) = lower + step * i;
      held.precision(k) = 0.0;
      x(k) = held.lower(k);
      const std::vector<Vector> starts{x};
      const ModelFit fit =
          fit_model(predictor, targets_, covariance(model.emulator, x), held, starts);
      x = fit.at;
      deviance[static_cast<std::size_t>(i)] = fit.deviance - fit.misfit + fit.objective;
    }
  };
  walk(middle, steps, 1);
  walk(middle - 1, -1, -1);
  // The square root of a gain is nearly straight: the limits lie between the grid's points.
  const double best = *std::ranges::min_element(deviance);
  const auto root = [&](int i) { return std::sqrt(deviance[static_cast<std::size_t>(i)] - best); };
  const double limit = std::sqrt(threshold);
  const auto crossing = [&](int inside, int outside) {
    const double share = (limit - root(inside)) / (root(outside) - root(inside));
    return lower + step * (inside + share * (outside - inside));
  };
  Range range{upper, lower};
  for (int i = 0; i < steps; ++i) {
    if (root(i) > limit) continue;
    range.lower =
        std::min(range.lower, i > 0 && root(i - 1) > limit ? crossing(i, i - 1) : lower + step * i);
    range.upper = std::max(
        range.upper, i + 1 < steps && root(i + 1) > limit ? crossing(i, i + 1) : lower + step * i);
  }
  return range;
}

}  // namespace repose::calibrator
