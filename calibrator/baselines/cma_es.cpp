#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "calibrator/baselines/baseline.hpp"
#include "engine/random.hpp"

namespace repose::calibrator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index population = 8;
constexpr Index parents = population / 2;
constexpr double first_step = 0.3;
constexpr double last_step = 1e-4;  // the search has converged

/// Constants of the strategy, by the defaults of the source (its table 1, without negative
/// weights).
struct Constants {
  explicit Constants(Index dimensions) : n(static_cast<double>(dimensions)), weights(parents) {
    for (Index i = 0; i < parents; ++i) {
      weights(i) = std::log(0.5 * (population + 1)) - std::log(static_cast<double>(i + 1));
    }
    weights /= weights.sum();
    mass = 1.0 / weights.squaredNorm();
    path_of_step = (mass + 2.0) / (n + mass + 5.0);
    damping = 1.0 + 2.0 * std::max(0.0, std::sqrt((mass - 1.0) / (n + 1.0)) - 1.0) + path_of_step;
    path_of_shape = (4.0 + mass / n) / (n + 4.0 + 2.0 * mass / n);
    rank_one = 2.0 / ((n + 1.3) * (n + 1.3) + mass);
    rank_mu =
        std::min(1.0 - rank_one, 2.0 * (mass - 2.0 + 1.0 / mass) / ((n + 2.0) * (n + 2.0) + mass));
    expected_length = std::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
  }

  double n;
  VectorXd weights;
  double mass = 0.0;  ///< effective number of parents
  double path_of_step = 0.0, damping = 0.0, path_of_shape = 0.0;
  double rank_one = 0.0, rank_mu = 0.0;
  double expected_length = 0.0;  ///< of a standard normal vector
};

class Strategy {
 public:
  explicit Strategy(Index dimensions)
      : k_(dimensions),
        mean_(VectorXd::Constant(dimensions, 0.5)),
        shape_(MatrixXd::Identity(dimensions, dimensions)),
        path_(VectorXd::Zero(dimensions)),
        step_path_(VectorXd::Zero(dimensions)) {}

  [[nodiscard]] bool converged() const {
    return step_ * std::sqrt(shape_.diagonal().maxCoeff()) < last_step;
  }

  [[nodiscard]] UnitPoint mean() const { return point(mean_); }

  /// The next generation. What falls outside the cube is put on its face.
  std::vector<UnitPoint> ask(engine::Random& random) {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(shape_);
    const VectorXd lengths = solver.eigenvalues().cwiseMax(1e-20).cwiseSqrt();
    root_ = solver.eigenvectors() * lengths.asDiagonal();
    whitening_ = solver.eigenvectors() * lengths.cwiseInverse().asDiagonal() *
                 solver.eigenvectors().transpose();
    std::vector<UnitPoint> points;
    for (Index i = 0; i < population; ++i) {
      VectorXd normal(mean_.size());
      for (double& z : normal) z = random.normal();
      points.push_back(point(mean_ + step_ * (root_ * normal)));
    }
    return points;
  }

  void tell(const std::vector<UnitPoint>& points, const std::vector<double>& misfits) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return misfits[i]; });
    MatrixXd steps(mean_.size(), parents);  // of the best, in units of the step
    for (Index i = 0; i < parents; ++i) {
      const UnitPoint& at = points[order[static_cast<std::size_t>(i)]];
      steps.col(i) = (Eigen::Map<const VectorXd>(at.data(), mean_.size()) - mean_) / step_;
    }
    const VectorXd shift = steps * k_.weights;
    mean_ += step_ * shift;
    ++generation_;
    step_path_ =
        (1.0 - k_.path_of_step) * step_path_ +
        std::sqrt(k_.path_of_step * (2.0 - k_.path_of_step) * k_.mass) * (whitening_ * shift);
    const double decay = 1.0 - std::pow(1.0 - k_.path_of_step, 2.0 * generation_);
    const bool fast =
        step_path_.norm() / std::sqrt(decay) >= (1.4 + 2.0 / (k_.n + 1.0)) * k_.expected_length;
    path_ *= 1.0 - k_.path_of_shape;
    if (!fast) path_ += std::sqrt(k_.path_of_shape * (2.0 - k_.path_of_shape) * k_.mass) * shift;
    const double kept = fast ? k_.path_of_shape * (2.0 - k_.path_of_shape) : 0.0;
    shape_ = (1.0 - k_.rank_one - k_.rank_mu + k_.rank_one * kept) * shape_ +
             k_.rank_one * path_ * path_.transpose() +
             k_.rank_mu * steps * k_.weights.asDiagonal() * steps.transpose();
    step_ *=
        std::exp(k_.path_of_step / k_.damping * (step_path_.norm() / k_.expected_length - 1.0));
    step_ = std::min(step_, 1.0);  // no wider than the cube
  }

 private:
  [[nodiscard]] static UnitPoint point(const VectorXd& at) {
    UnitPoint result(at.begin(), at.end());
    for (double& u : result) u = std::clamp(u, 0.0, 1.0);
    return result;
  }

  Constants k_;
  VectorXd mean_;
  MatrixXd shape_;
  MatrixXd root_;
  MatrixXd whitening_;
  VectorXd path_;
  VectorXd step_path_;
  double step_ = first_step;
  int generation_ = 0;
};

}  // namespace

/// Covariance matrix adaptation: a compact one, eight to a generation. Source: Hansen 2016
/// (arXiv 1604.00772).
bool search_by_cma_es(BaselineSearch& search) {
  Strategy strategy(static_cast<Index>(search.dimensions()));
  engine::Random random(search.seed(), engine::Purpose::proposal);
  while (search.left() >= population && !strategy.converged()) {
    const std::vector<UnitPoint> points = strategy.ask(random);
    strategy.tell(points, search.evaluate(points));
    search.recommend(strategy.mean());
  }
  return strategy.converged();
}

}  // namespace repose::calibrator
