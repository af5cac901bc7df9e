#include "calibrator/surrogate.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "calibrator/draft_help.hpp"
#include "calibrator/optimiser.hpp"

namespace repose::calibrator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double linear_variance = 3.0;  // sl2: a slope of a few standard deviations is expected
constexpr double jitter = 1e-9;          // keeps nearly equal points factorable

// Priors on the logarithms, from calibration.md 7.3, tried there on the analytic bench.
constexpr double log_length_mean = -0.35667494393873245;  // log 0.7
constexpr double log_length_deviation = 0.9;
constexpr double log_signal_mean = -1.0;
constexpr double log_noise_deviation = 0.7;
constexpr double shortest = 0.08;
constexpr double longest = 8.0;

const double root5 = std::sqrt(5.0);

double squared(double x) { return x * x; }

/// M of r^2, for a whole array at once.
template <class A>
Eigen::ArrayXd matern(const A& r2) {
  const Eigen::ArrayXd t = (5.0 * r2).sqrt();
  return (1.0 + t + t.square() / 3.0) * (-t).exp();
}

MatrixXd rows(std::span<const Sample> samples) {
  const auto d = static_cast<Index>(samples.front().at.size());
  MatrixXd at(static_cast<Index>(samples.size()), d);
  for (Index i = 0; i < at.rows(); ++i) {
    for (Index k = 0; k < d; ++k) {
      at(i, k) = samples[static_cast<std::size_t>(i)].at[static_cast<std::size_t>(k)];
    }
  }
  return at;
}

/// The part of the likelihood that does not depend on the hyper-parameters, kept between its
/// evaluations: there are hundreds per fit.
class Likelihood {
 public:
  Likelihood(const MatrixXd& at, VectorXd y, VectorXd noise)
      : y_(std::move(y)), noise_(std::move(noise)) {
    const Index n = at.rows();
    squares_.resize(n * (n + 1) / 2, at.cols());
    linear_.resize(squares_.rows());
    Index row = 0;
    for (Index j = 0; j < n; ++j) {
      for (Index i = j; i < n; ++i, ++row) {
        squares_.row(row) = (at.row(i) - at.row(j)).array().square();
        linear_(row) = linear_variance *
                       (at.row(i).array() - 0.5).matrix().dot((at.row(j).array() - 0.5).matrix());
      }
    }
  }

  /// The lower triangle of the samples' covariance.
  [[nodiscard]] MatrixXd covariance(const Hyperparameters& h) const {
    const Index n = y_.size();
    Eigen::ArrayXd r2 = Eigen::ArrayXd::Zero(squares_.rows());
    for (Index k = 0; k < squares_.cols(); ++k) {
      r2 += squares_.col(k) / squared(h.length[static_cast<std::size_t>(k)]);
    }
    const Eigen::ArrayXd packed = h.signal * matern(r2) + linear_;
    MatrixXd full = MatrixXd::Zero(n, n);
    for (Index j = 0, row = 0; j < n; row += n - j, ++j) {
      full.col(j).tail(n - j) = packed.segment(row, n - j);
    }
    full.diagonal() += h.noise * noise_;
    full.diagonal().array() += jitter;
    return full;
  }

  /// Minus the logarithm of restricted likelihood times prior, a constant apart.
  [[nodiscard]] double cost(const Hyperparameters& h) const {
    const Eigen::LLT<MatrixXd> root(covariance(h));
    if (root.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
    const VectorXd a = root.matrixL().solve(y_);
    const VectorXd b = root.matrixL().solve(VectorXd::Ones(y_.size()));
    const double bb = b.squaredNorm();
    const double fit = a.squaredNorm() - squared(a.dot(b)) / bb;
    const double logs = 2.0 * root.matrixLLT().diagonal().array().log().sum() + std::log(bb);
    double prior = squared(std::log(h.signal) - log_signal_mean) +
                   squared(std::log(h.noise) / log_noise_deviation);
    for (const double l : h.length) {
      prior += squared((std::log(l) - log_length_mean) / log_length_deviation);
    }
    return 0.5 * (fit + logs + prior);
  }

 private:
  VectorXd y_;
  VectorXd noise_;
  Eigen::ArrayXXd squares_;  ///< one row per pair of samples, i >= j, column by column of j
  Eigen::ArrayXd linear_;
};

std::vector<double> logarithms(const Hyperparameters& h) {
  std::vector<double> result;
  for (const double l : h.length) result.push_back(std::log(l));
  result.push_back(std::log(h.signal));
  result.push_back(std::log(h.noise));
  return result;
}

Hyperparameters from_logarithms(std::span<const double> logs) {
  const std::size_t d = logs.size() - 2;
  Hyperparameters h;
  for (std::size_t k = 0; k < d; ++k) h.length.push_back(std::exp(logs[k]));
  h.signal = std::exp(logs[d]);
  h.noise = std::exp(logs[d + 1]);
  return h;
}

Box bounds(std::size_t dimensions) {
  Box box{std::vector<double>(dimensions, std::log(shortest)),
          std::vector<double>(dimensions, std::log(longest))};
  box.lower.insert(box.lower.end(), {-6.0, -3.0});  // five and four prior deviations
  box.upper.insert(box.upper.end(), {4.0, 3.0});
  return box;
}

}  // namespace

Hyperparameters prior_mode(std::size_t dimensions) {
  return {
      std::vector<double>(dimensions, std::exp(log_length_mean)), std::exp(log_signal_mean), 1.0};
}

GaussianProcess::GaussianProcess(std::vector<Sample> samples, Hyperparameters hyperparameters)
    : GaussianProcess(std::move(samples), std::move(hyperparameters), Standard{0.0, 0.0}) {}

GaussianProcess::GaussianProcess(std::vector<Sample> samples,
                                 Hyperparameters hyperparameters,
                                 Standard standard)
    : samples_(std::move(samples)),
      hyperparameters_(std::move(hyperparameters)),
      standard_(standard) {
  assert(!samples_.empty());
  const auto n = static_cast<Index>(samples_.size());
  VectorXd y(n);
  VectorXd noise(n);
  for (Index i = 0; i < n; ++i) {
    y(i) = samples_[static_cast<std::size_t>(i)].value;
    noise(i) = samples_[static_cast<std::size_t>(i)].variance;
  }
  if (standard_.scale <= 0.0) {
    standard_.shift = y.mean();
    const double spread = std::sqrt((y.array() - standard_.shift).square().mean());
    // Samples that are all alike: their noise is the only scale there is.
    standard_.scale = std::max({spread, std::sqrt(noise.mean()), 1e-12 * std::abs(y(0)), 1e-300});
  }
  y = (y.array() - standard_.shift) / standard_.scale;
  noise /= squared(standard_.scale);
  at_ = rows(samples_);
  root_.compute(Likelihood(at_, y, noise).covariance(hyperparameters_));
  ones_ = root_.solve(VectorXd::Ones(n));
  ones_sum_ = ones_.sum();
  mean_ = ones_.dot(y) / ones_sum_;
  weights_ = root_.solve((y.array() - mean_).matrix());
  check_leave_one_out();
}

/// Residual i without sample i: (Q y)_i / Q_ii, variance 1 / Q_ii, Q = K^-1 - K^-1 1 1' K^-1 / 1'
/// K^-1 1.
void GaussianProcess::check_leave_one_out() {
  const Index n = at_.rows();
  if (n < 3) return;
  const MatrixXd inverse = root_.solve(MatrixXd::Identity(n, n));
  const VectorXd precision = inverse.diagonal() - ones_.cwiseAbs2() / ones_sum_;
  leave_one_out_ =
      (weights_.array().square() / precision.array().max(1e-12)).mean();  // weights = Q y
  // Below a quarter the samples are too few to be trusted that far.
  if (leave_one_out_ < 0.5 || leave_one_out_ > 2.0) inflation_ = std::max(leave_one_out_, 0.25);
}

GaussianProcess GaussianProcess::fit(std::vector<Sample> samples,
                                     std::span<const Hyperparameters> starts) {
  assert(!samples.empty() && !starts.empty());
  const std::size_t d = samples.front().at.size();
  // Standardised exactly as the process itself will be.
  const GaussianProcess plain(samples, starts.front());
  const auto n = static_cast<Index>(samples.size());
  VectorXd y(n);
  VectorXd noise(n);
  for (Index i = 0; i < n; ++i) {
    const Sample& sample = samples[static_cast<std::size_t>(i)];
    y(i) = (sample.value - plain.standard_.shift) / plain.standard_.scale;
    noise(i) = sample.variance / squared(plain.standard_.scale);
  }
  const Likelihood likelihood(plain.at_, std::move(y), std::move(noise));
  const Objective objective = [&](std::span<const double> logs) {
    return likelihood.cost(from_logarithms(logs));
  };
  const Box box = bounds(d);
  Minimum best;
  for (const Hyperparameters& start : starts) {
    Minimum found = minimise_locally(
        objective,
        box,
        logarithms(start),
        {.evaluations = 60 + 10 * static_cast<int>(d), .step = 0.5, .tolerance = 1e-3});
    if (best.at.empty() || found.value < best.value) best = std::move(found);
  }
  return {std::move(samples), from_logarithms(best.at), plain.standard_};
}

VectorXd GaussianProcess::covariances(std::span<const double> point) const {
  Eigen::ArrayXd r2 = Eigen::ArrayXd::Zero(at_.rows());
  VectorXd linear = VectorXd::Zero(at_.rows());
  for (Index k = 0; k < at_.cols(); ++k) {
    const double u = point[static_cast<std::size_t>(k)];
    const double l = hyperparameters_.length[static_cast<std::size_t>(k)];
    r2 += ((at_.col(k).array() - u) / l).square();
    linear.array() += (linear_variance * (u - 0.5)) * (at_.col(k).array() - 0.5);
  }
  return hyperparameters_.signal * matern(r2).matrix() + linear;
}

double GaussianProcess::prior_variance(std::span<const double> point) const {
  double sum = 0.0;
  for (const double u : point) sum += squared(u - 0.5);
  return hyperparameters_.signal + linear_variance * sum;
}

Belief GaussianProcess::at(std::span<const double> point) const {
  const VectorXd k = covariances(point);
  const double mean = mean_ + k.dot(weights_);
  const double known = root_.matrixL().solve(k).squaredNorm();
  const double of_mean = squared(1.0 - k.dot(ones_)) / ones_sum_;
  const double variance = std::max(prior_variance(point) - known + of_mean, 0.0) * inflation_;
  return {standard_.shift + standard_.scale * mean, squared(standard_.scale) * variance};
}

std::vector<Belief> GaussianProcess::at_each(std::span<const UnitPoint> points) const {
  MatrixXd cross(at_.rows(), static_cast<Index>(points.size()));
  for (Index i = 0; i < cross.cols(); ++i) {
    cross.col(i) = covariances(points[static_cast<std::size_t>(i)]);
  }
  const VectorXd means = cross.transpose() * weights_;
  const VectorXd rest = (1.0 - (cross.transpose() * ones_).array()).matrix();
  root_.matrixL().solveInPlace(cross);
  std::vector<Belief> beliefs;
  for (Index i = 0; i < cross.cols(); ++i) {
    const double prior = prior_variance(points[static_cast<std::size_t>(i)]);
    const double variance =
        std::max(prior - cross.col(i).squaredNorm() + squared(rest(i)) / ones_sum_, 0.0);
    beliefs.push_back({standard_.shift + standard_.scale * (mean_ + means(i)),
                       squared(standard_.scale) * variance * inflation_});
  }
  return beliefs;
}

VectorXd GaussianProcess::gradient(std::span<const double> point) const {
  const auto& length = hyperparameters_.length;
  VectorXd result = VectorXd::Zero(at_.cols());
  for (Index i = 0; i < at_.rows(); ++i) {
    double r2 = 0.0;
    for (Index k = 0; k < at_.cols(); ++k) {
      const auto kk = static_cast<std::size_t>(k);
      r2 += squared((point[kk] - at_(i, k)) / length[kk]);
    }
    const double t = root5 * std::sqrt(r2);
    const double slope = -hyperparameters_.signal * (5.0 / 3.0) * (1.0 + t) * std::exp(-t);
    for (Index k = 0; k < at_.cols(); ++k) {
      const auto kk = static_cast<std::size_t>(k);
      result(k) += weights_(i) * (slope * (point[kk] - at_(i, k)) / squared(length[kk]) +
                                  linear_variance * (at_(i, k) - 0.5));
    }
  }
  return standard_.scale * result;
}

GaussianProcess::Joint GaussianProcess::at_all(std::span<const UnitPoint> points) const {
  const auto count = static_cast<Index>(points.size());
  MatrixXd cross(at_.rows(), count);
  Joint joint{VectorXd(count), MatrixXd(count, count)};
  for (Index i = 0; i < count; ++i) {
    const auto& a = points[static_cast<std::size_t>(i)];
    cross.col(i) = covariances(a);
    for (Index j = 0; j <= i; ++j) {
      const auto& b = points[static_cast<std::size_t>(j)];
      Eigen::ArrayXd r2 = Eigen::ArrayXd::Zero(1);
      double linear = 0.0;
      for (std::size_t k = 0; k < a.size(); ++k) {
        r2(0) += squared((a[k] - b[k]) / hyperparameters_.length[k]);
        linear += (a[k] - 0.5) * (b[k] - 0.5);
      }
      joint.covariance(i, j) = hyperparameters_.signal * matern(r2)(0) + linear_variance * linear;
    }
  }
  const MatrixXd known = root_.matrixL().solve(cross);
  const VectorXd rest = (1.0 - (cross.transpose() * ones_).array()).matrix();
  joint.covariance = joint.covariance.selfadjointView<Eigen::Lower>();
  joint.covariance += rest * rest.transpose() / ones_sum_ - known.transpose() * known;
  joint.covariance *= squared(standard_.scale) * inflation_;
  joint.mean =
      (standard_.shift + standard_.scale * (mean_ + (cross.transpose() * weights_).array()))
          .matrix();
  return joint;
}

GaussianProcess GaussianProcess::believing(std::span<const UnitPoint> points,
                                           double variance) const {
  std::vector<Sample> samples = samples_;
  for (const UnitPoint& point : points) samples.push_back({point, at(point).mean, variance});
  GaussianProcess result(std::move(samples), hyperparameters_, standard_);
  result.leave_one_out_ = leave_one_out_;  // what was only believed is no evidence
  result.inflation_ = inflation_;
  return result;
}

namespace {

std::vector<Sample> samples_of(const Ledger& ledger,
                               std::size_t measurement,
                               double pooled,
                               const DraftHelp* help) {
  std::vector<Sample> samples;
  for (const Site& site : ledger.sites()) {
    const RunMean runs = mean_of(site.searched, measurement);
    if (runs.count > 0) {
      samples.push_back({site.at, runs.mean, run_variance(runs, pooled) / runs.count});
      continue;
    }
    const RunMean drafts = mean_of(site.drafted, measurement);
    if (help == nullptr || !help->proven || drafts.count == 0) continue;
    samples.push_back(
        {site.at, help->value(drafts.mean), std::max(help->variance(drafts.mean), pooled)});
  }
  return samples;
}

}  // namespace

Surrogate::Surrogate(const Ledger& ledger, const Surrogate* previous)
    : refits_(previous == nullptr ? 0 : previous->refits_ + 1) {
  const std::size_t d = ledger.space().dimensions();
  const Scatter scatter = ledger.scatter(Level::search);
  const std::vector<DraftHelp> help = learn_draft_help(ledger);
  for (std::size_t j = 0; j < scatter.variance.size(); ++j) {
    std::vector<Sample> samples =
        samples_of(ledger, j, scatter.variance[j], help.empty() ? nullptr : &help[j]);
    if (samples.empty()) {
      processes_.emplace_back();
      continue;
    }
    std::vector<Hyperparameters> starts;
    if (previous != nullptr && previous->processes_[j]) {
      starts.push_back(previous->processes_[j]->hyperparameters());
    }
    if (starts.empty() || refits_ % 6 == 0) starts.push_back(prior_mode(d));
    processes_.emplace_back(GaussianProcess::fit(std::move(samples), starts));
  }
}

Belief Surrogate::at(std::size_t measurement, std::span<const double> point) const {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const auto& process = processes_[measurement];
  return process ? process->at(point) : Belief{unknown, unknown};
}

Surrogate Surrogate::believing(std::span<const UnitPoint> points,
                               std::span<const double> variance) const {
  std::vector<std::optional<GaussianProcess>> processes;
  for (std::size_t j = 0; j < processes_.size(); ++j) {
    processes.emplace_back();
    if (processes_[j]) processes.back() = processes_[j]->believing(points, variance[j]);
  }
  return Surrogate(std::move(processes));
}

}  // namespace repose::calibrator
