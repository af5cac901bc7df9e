#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "calibrator/baselines/baseline.hpp"
#include "calibrator/design.hpp"
#include "engine/random.hpp"

namespace repose::calibrator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double least_effective = 0.3;  // of the samples: share that the weights leave effective

/// Samples of one iteration and their normalised weights.
struct Cloud {
  std::vector<UnitPoint> at;
  VectorXd weights;

  [[nodiscard]] double effective() const { return 1.0 / weights.squaredNorm(); }
};

VectorXd normalised_weights(const std::vector<double>& misfits, double softness) {
  const double smallest = *std::ranges::min_element(misfits);
  VectorXd weights(static_cast<Index>(misfits.size()));
  for (Index i = 0; i < weights.size(); ++i) {
    weights(i) = std::exp(-0.5 * (misfits[static_cast<std::size_t>(i)] - smallest) / softness);
  }
  return weights / weights.sum();
}

/// Gaussian likelihood whose covariance is widened (never narrowed) until the effective sample size
/// is large enough.
VectorXd weigh(const std::vector<double>& misfits) {
  const double wanted = least_effective * static_cast<double>(misfits.size());
  double softness = 1.0;
  VectorXd weights = normalised_weights(misfits, softness);
  while (1.0 / weights.squaredNorm() < wanted && softness < 1e12) {
    softness *= 1.2;
    weights = normalised_weights(misfits, softness);
  }
  return weights;
}

VectorXd mean_of(const Cloud& cloud) {
  VectorXd mean = VectorXd::Zero(static_cast<Index>(cloud.at.front().size()));
  for (std::size_t i = 0; i < cloud.at.size(); ++i) {
    mean += cloud.weights(static_cast<Index>(i)) *
            Eigen::Map<const VectorXd>(cloud.at[i].data(), mean.size());
  }
  return mean;
}

/// Draws from the weighted samples, each smeared by a Gaussian kernel of Silverman's width (1986,
/// Density Estimation, eq. 4.14).
std::vector<UnitPoint> resample(const Cloud& cloud, engine::Random& random) {
  const VectorXd mean = mean_of(cloud);
  const auto d = static_cast<double>(mean.size());
  MatrixXd covariance = 1e-10 * MatrixXd::Identity(mean.size(), mean.size());
  for (std::size_t i = 0; i < cloud.at.size(); ++i) {
    const VectorXd gap = Eigen::Map<const VectorXd>(cloud.at[i].data(), mean.size()) - mean;
    covariance += cloud.weights(static_cast<Index>(i)) * gap * gap.transpose();
  }
  const double width = std::pow(4.0 / (cloud.effective() * (d + 2.0)), 1.0 / (d + 4.0));
  const MatrixXd kernel = width * MatrixXd(covariance.llt().matrixL());
  std::vector<UnitPoint> points;
  const auto count = static_cast<double>(cloud.at.size());
  const double offset = random.uniform();  // systematic resampling: one draw, then even strides
  double passed = cloud.weights(0);
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < cloud.at.size(); ++i) {
    while ((static_cast<double>(i) + offset) / count > passed && chosen + 1 < cloud.at.size()) {
      passed += cloud.weights(static_cast<Index>(++chosen));
    }
    VectorXd normal(mean.size());
    for (double& z : normal) z = random.normal();
    const VectorXd shift = kernel * normal;
    points.push_back(cloud.at[chosen]);
    for (std::size_t k = 0; k < points.back().size(); ++k) {
      points.back()[k] = std::clamp(points.back()[k] + shift(static_cast<Index>(k)), 0.0, 1.0);
    }
  }
  return points;
}

}  // namespace

/// The iterative Bayesian filter, compact: a space-filling cloud of 5 d ln d points, weighed by the
/// likelihood of one run each; the next cloud is drawn from the smoothed weights of the last, which
/// are not divided by the density they were drawn from. Source: Cheng et al. 2019 (Comput. Methods
/// Appl. Mech. Eng. 350, 268-294); the smoothing there is a Gaussian mixture.
bool search_by_filter(BaselineSearch& search) {
  const auto d = static_cast<double>(search.dimensions());
  const int samples = std::max(10, static_cast<int>(std::lround(5.0 * d * std::log(d))));
  engine::Random random(search.seed(), engine::Purpose::proposal);
  Cloud cloud;
  cloud.at = latin_hypercube(static_cast<std::size_t>(std::min(samples, search.left())),
                             search.dimensions(),
                             search.seed());
  while (!cloud.at.empty() && search.left() >= static_cast<int>(cloud.at.size())) {
    const std::vector<double> misfits = search.evaluate(cloud.at);
    if (!std::isfinite(*std::ranges::min_element(misfits))) return false;  // all of them failed
    cloud.weights = weigh(misfits);
    const VectorXd mean = mean_of(cloud);
    search.recommend({mean.begin(), mean.end()});
    cloud.at = resample(cloud, random);
  }
  return false;
}

}  // namespace repose::calibrator
