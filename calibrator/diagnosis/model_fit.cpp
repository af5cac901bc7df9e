#include "calibrator/diagnosis/model_fit.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/Cholesky>

namespace repose::calibrator {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

struct Problem {
  const Predictor& predictor;
  const Vector& targets;
  const Matrix& whitener;
  const ModelSpace& space;
};

struct Place {
  Vector x;
  Vector residuals;  ///< whitened
  Vector pull;       ///< of the prior
  double objective = 0.0;
};

Place place_at(const Problem& problem, Vector x) {
  Place place{std::move(x), {}, {}, 0.0};
  place.residuals = problem.whitener * (problem.targets - problem.predictor.mean(place.x));
  place.pull = problem.space.precision.cwiseProduct(problem.space.centre - place.x);
  place.objective = place.residuals.squaredNorm() + place.pull.squaredNorm();
  return place;
}

/// Coordinates that are not held at a bound by the downhill direction.
std::vector<Index> not_held(const Place& place, const ModelSpace& space, const Vector& downhill) {
  std::vector<Index> free;
  for (Index k = 0; k < place.x.size(); ++k) {
    const bool below = place.x(k) <= space.lower(k) + 1e-12 && downhill(k) < 0.0;
    const bool above = place.x(k) >= space.upper(k) - 1e-12 && downhill(k) > 0.0;
    if (!below && !above) free.push_back(k);
  }
  return free;
}

Vector downhill(const Problem& problem, const Place& place, const Matrix& jacobian) {
  return jacobian.transpose() * place.residuals + problem.space.precision.cwiseProduct(place.pull);
}

Matrix curvature(const Problem& problem, const Matrix& jacobian) {
  Matrix h = jacobian.transpose() * jacobian;
  h.diagonal() += problem.space.precision.cwiseAbs2();
  return h;
}

Place search(const Problem& problem, const Vector& start) {
  constexpr int iterations = 25, tries = 8;
  const ModelSpace& space = problem.space;
  Place here = place_at(problem, start.cwiseMax(space.lower).cwiseMin(space.upper));
  double damping = 1e-3;
  for (int i = 0; i < iterations; ++i) {
    const Matrix jacobian = problem.whitener * problem.predictor.jacobian(here.x);
    const Vector slope = downhill(problem, here, jacobian);
    const std::vector<Index> free = not_held(here, space, slope);
    if (free.empty()) break;
    const Matrix h = curvature(problem, jacobian)(free, free);
    bool better = false;
    double gain = 0.0;
    for (int t = 0; t < tries && !better; ++t) {
      Matrix damped = h;
      damped.diagonal() *= 1.0 + damping;
      Vector x = here.x;
      x(free) += damped.llt().solve(slope(free));
      Place next = place_at(problem, x.cwiseMax(space.lower).cwiseMin(space.upper));
      better = next.objective <= here.objective + 1e-12;
      gain = here.objective - next.objective;
      if (better) here = std::move(next);
      damping = better ? std::max(damping / 5.0, 1e-8) : damping * 5.0;
    }
    if (!better || gain < 1e-6) break;
  }
  return here;
}

}  // namespace

ModelFit fit_model(const Predictor& predictor,
                   const Vector& targets,
                   const Matrix& covariance,
                   const ModelSpace& space,
                   std::span<const Vector> starts) {
  assert(!starts.empty());
  const Eigen::LLT<Matrix> root(covariance);
  ModelFit fit;
  fit.whitener = root.matrixL().solve(Matrix::Identity(targets.size(), targets.size()));
  const Problem problem{predictor, targets, fit.whitener, space};
  Place best;
  for (const Vector& start : starts) {
    Place found = search(problem, start);
    if (best.x.size() == 0 || found.objective < best.objective) best = std::move(found);
  }
  fit.at = best.x;
  fit.residuals = best.residuals;
  fit.objective = best.objective;
  fit.misfit = best.residuals.squaredNorm();
  const Matrix lower = root.matrixLLT();
  fit.deviance = fit.misfit + 2.0 * lower.diagonal().array().log().sum();
  fit.jacobian = fit.whitener * predictor.jacobian(fit.at);
  fit.inside = not_held(best, space, downhill(problem, best, fit.jacobian));
  // Effective number of parameters: trace of the data's share in the curvature.
  const Matrix j = fit.jacobian(Eigen::all, fit.inside);
  Matrix h = j.transpose() * j;
  const Matrix data = h;
  h.diagonal() += space.precision(fit.inside).cwiseAbs2();
  fit.freedom = static_cast<double>(targets.size());
  if (!fit.inside.empty()) fit.freedom -= h.llt().solve(data).trace();
  return fit;
}

}  // namespace repose::calibrator
