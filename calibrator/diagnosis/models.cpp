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
constexpr int profile_steps = 27;   // of the strength

/// -2 log posterior but for a constant.
double evidence_against(const ModelFit& fit) { return fit.deviance - fit.misfit + fit.objective; }

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
  settle(model, starts);
  return model;
}

void Models::settle(Model& model, std::span<const Vector> starts) const {
  const Predictor predictor = this->predictor(model.emulator);
  model.fit = fit_model(
      predictor, targets_, covariance(model.emulator, starts.front()), model.space, starts);
  // The emulator's own uncertainty is the one where the model came to lie.
  const std::vector<Vector> again{model.fit.at};
  model.fit =
      fit_model(predictor, targets_, covariance(model.emulator, model.fit.at), model.space, again);
}

std::vector<ModelFit> Models::profile(const Model& model) const {
  const auto k = static_cast<Index>(runs_.space().dimensions());
  const double lower = model.space.lower(k);
  const double step = (model.space.upper(k) - lower) / (profile_steps - 1);
  const Predictor predictor = this->predictor(model.emulator);
  std::vector<ModelFit> fits(profile_steps);
  const auto walk = [&](int from, int to, int direction) {
    Vector x = model.fit.at;
    for (int i = from; i != to; i += direction) {
      ModelSpace held = model.space;
      held.lower(k) = held.upper(k) = lower + step * i;
      x(k) = held.lower(k);
      const std::vector<Vector> starts{x};
      ModelFit& fit = fits[static_cast<std::size_t>(i)];
      fit = fit_model(predictor, targets_, covariance(model.emulator, x), held, starts);
      x = fit.at;
    }
  };
  const int middle = std::clamp(
      static_cast<int>(std::lround((model.fit.at(k) - lower) / step)), 0, profile_steps - 1);
  walk(middle, profile_steps, 1);
  walk(middle - 1, -1, -1);
  return fits;
}

void Models::deepen(Model& model) const {
  const ModelFit found = model.fit;
  const std::vector<ModelFit> fits = profile(model);
  const ModelFit& deepest = *std::ranges::min_element(fits, {}, &evidence_against);
  if (evidence_against(deepest) >= evidence_against(found)) return;
  const std::vector<Vector> starts{deepest.at};
  settle(model, starts);
  if (evidence_against(model.fit) >= evidence_against(found)) model.fit = found;
}

Models::Range Models::strength_range(const Model& model) const {
  const auto k = static_cast<Index>(runs_.space().dimensions());
  const std::vector<ModelFit> fits = profile(model);
  const double best =
      std::min(evidence_against(model.fit),
               evidence_against(*std::ranges::min_element(fits, {}, &evidence_against)));
  // The square root of a gain is nearly straight: the limits lie between the grid's points.
  const auto root = [&](const ModelFit& fit) { return std::sqrt(evidence_against(fit) - best); };
  const double limit = std::sqrt(threshold);
  const auto crossing = [&](const ModelFit& inside, const ModelFit& outside) {
    const double share = (limit - root(inside)) / (root(outside) - root(inside));
    return inside.at(k) + share * (outside.at(k) - inside.at(k));
  };
  Range range{model.fit.at(k), model.fit.at(k)};
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (root(fits[i]) > limit) continue;
    const bool below = i > 0 && root(fits[i - 1]) > limit;
    const bool above = i + 1 < fits.size() && root(fits[i + 1]) > limit;
    range.lower = std::min(range.lower, below ? crossing(fits[i], fits[i - 1]) : fits[i].at(k));
    range.upper = std::max(range.upper, above ? crossing(fits[i], fits[i + 1]) : fits[i].at(k));
  }
  return range;
}

}  // namespace repose::calibrator
