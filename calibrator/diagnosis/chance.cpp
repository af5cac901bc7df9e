#include "calibrator/diagnosis/chance.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/QR>

#include "calibrator/diagnosis/chi_squared.hpp"

namespace repose::calibrator {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// A Student's t with that many degrees of freedom; beyond a hundred a normal.
double draw_t(engine::Random& random, double freedom) {
  const double normal = random.normal();
  if (!(freedom < 100.0)) return normal;
  double sum = 0.0;
  const int whole = std::max(1, static_cast<int>(std::lround(freedom)));
  for (int i = 0; i < whole; ++i) {
    const double x = random.normal();
    sum += x * x;
  }
  return normal / std::sqrt(sum / whole);
}

Matrix orthonormal(const Matrix& columns) {
  return Eigen::HouseholderQR<Matrix>(columns).householderQ() *
         Matrix::Identity(columns.rows(), columns.cols());
}

/// Share of draws of the errors that leave at least that misfit.
double share_beyond(double misfit,
                    std::uint64_t seed,
                    const std::function<double(engine::Random&)>& draw) {
  constexpr int draws = 4000;
  int beyond = 0;
  for (int d = 0; d < draws; ++d) {
    engine::Random random(seed, engine::Purpose::diagnosis_null, static_cast<std::uint64_t>(d));
    if (draw(random) >= misfit) ++beyond;
  }
  return static_cast<double>(beyond) / draws;
}

}  // namespace

Matrix projector_off(const ModelFit& fit, const ModelSpace& space) {
  const Index data = fit.jacobian.rows();
  const auto inside = static_cast<Index>(fit.inside.size());
  Matrix tangent = Matrix::Zero(data + inside, inside);
  tangent.topRows(data) = fit.jacobian(Eigen::all, fit.inside);
  tangent.bottomRows(inside).diagonal() = space.precision(fit.inside);
  Matrix projector = Matrix::Identity(data + inside, data + inside);
  if (inside == 0) return projector;
  const Matrix q = orthonormal(tangent);
  return projector - q * q.transpose();
}

Vector draw_errors(engine::Random& random, const Vector& freedom, Index rows) {
  Vector errors(rows);
  for (Index i = 0; i < rows; ++i) {
    errors(i) = i < freedom.size() ? draw_t(random, freedom(i)) : random.normal();
  }
  return errors;
}

double misfit_p(const ModelFit& fit,
                const ModelSpace& space,
                const Vector& freedom,
                std::uint64_t seed) {
  if (!freedom.array().isFinite().any()) return chi_squared_tail(fit.misfit, fit.freedom);
  const Matrix projector = projector_off(fit, space);
  const Matrix left = projector.topRows(freedom.size());
  return share_beyond(fit.misfit, seed, [&](engine::Random& random) {
    return (left * draw_errors(random, freedom, projector.cols())).squaredNorm();
  });
}

double misfit_p(double misfit, Index directions, const Vector& freedom, std::uint64_t seed) {
  const Index count = freedom.size();
  if (directions >= count || !freedom.array().isFinite().any()) {
    return chi_squared_tail(misfit, static_cast<double>(count - directions));
  }
  return share_beyond(misfit, seed, [&](engine::Random& random) {
    const Vector errors = draw_errors(random, freedom, count);
    if (directions == 0) return errors.squaredNorm();
    Matrix any(count, directions);
    for (double& x : any.reshaped()) x = random.normal();
    return errors.squaredNorm() - (orthonormal(any).transpose() * errors).squaredNorm();
  });
}

}  // namespace repose::calibrator
