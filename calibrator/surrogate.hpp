/// Gaussian processes in place of the simulations: one per measurement, over the unit cube.
///
///   f(u) = m + Z(u),   cov = sf2 M(r) + sl2 (u - 1/2)'(u' - 1/2),
///   r^2  = sum_k ((u_k - u'_k) / l_k)^2,
///   M(r) = (1 + sqrt5 r + 5 r^2 / 3) exp(-sqrt5 r)    (Matern 5/2)
///   y_i  = f(u_i) + e_i,   var e_i = h s_i^2 / R_i
///
///   m    constant mean, by generalised least squares     l_k  correlation lengths, 1
///   sf2  variance of the curved part, sl2 = 3 of the linear part, both over the variance of the y_i
///   s_i  scatter of one run, R_i runs at u_i             h    noise factor, 1
///
/// l, sf2 and h maximise the restricted likelihood times priors (log-normal, constants in the
/// source).
///
/// Source: Rasmussen & Williams 2006, eqs. 2.25-2.26, 2.41-2.42, 4.17; noise of replicated points:
///         Ankenman, Nelson & Staum 2010, Oper. Res. 58, 371-382.
/// Check:  the leave-one-out residuals (Dubrule 1983, Math. Geol. 15, 687-699), standardised, have
///         mean square 1; where they do not by a factor of two, predicted variances are multiplied
///         by it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "calibrator/ledger.hpp"
#include "calibrator/search_space.hpp"

namespace repose::calibrator {

struct Sample {
  UnitPoint at;
  double value = 0.0;
  double variance = 0.0;  ///< of the noise in `value`
};

struct Hyperparameters {
  std::vector<double> length;  ///< l_k
  double signal = 0.37;        ///< sf2
  double noise = 1.0;          ///< h
};

/// The mode of the priors: where a fit starts that knows nothing.
Hyperparameters prior_mode(std::size_t dimensions);

struct Belief {
  double mean = 0.0;
  double variance = 0.0;  ///< of f, the noise of a run apart
};

class GaussianProcess {
 public:
  /// With given hyper-parameters. At least one sample.
  GaussianProcess(std::vector<Sample> samples, Hyperparameters hyperparameters);

  /// With those that fit best; `starts` are where to look for them.
  static GaussianProcess fit(std::vector<Sample> samples, std::span<const Hyperparameters> starts);

  [[nodiscard]] Belief at(std::span<const double> point) const;

  /// The same of many points, faster; equal but for rounding.
  [[nodiscard]] std::vector<Belief> at_each(std::span<const UnitPoint> points) const;

  /// d mean / d u_k.
  [[nodiscard]] Eigen::VectorXd gradient(std::span<const double> point) const;

  /// Beliefs about several points together.
  struct Joint {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
  };
  [[nodiscard]] Joint at_all(std::span<const UnitPoint> points) const;

  /// The same process once runs at these points have come out as predicted: the mean stays, the
  /// variance shrinks.
  [[nodiscard]] GaussianProcess believing(std::span<const UnitPoint> points, double variance) const;

  [[nodiscard]] const Hyperparameters& hyperparameters() const { return hyperparameters_; }
  /// Mean square of the standardised leave-one-out residuals.
  [[nodiscard]] double leave_one_out() const { return leave_one_out_; }

 private:
  struct Standard {
    double shift = 0.0;
    double scale = 1.0;
  };
  GaussianProcess(std::vector<Sample> samples, Hyperparameters hyperparameters, Standard standard);
  void check_leave_one_out();
  [[nodiscard]] Eigen::VectorXd covariances(std::span<const double> point) const;
  [[nodiscard]] double prior_variance(std::span<const double> point) const;

  std::vector<Sample> samples_;
  Hyperparameters hyperparameters_;
  Standard standard_;
  Eigen::MatrixXd at_;                ///< one row per sample
  Eigen::LLT<Eigen::MatrixXd> root_;  ///< of the samples' covariance
  Eigen::VectorXd weights_;           ///< K^-1 (y - m)
  Eigen::VectorXd ones_;              ///< K^-1 1
  double ones_sum_ = 0.0;             ///< 1' K^-1 1
  double mean_ = 0.0;                 ///< m
  double leave_one_out_ = 1.0;
  double inflation_ = 1.0;
};

/// One process per measurement.
class Surrogate {
 public:
  /// Learns from the runs at the search level. `previous` is where the hyper-parameters start;
  /// every sixth refit starts from the priors as well.
  Surrogate(const Ledger& ledger, const Surrogate* previous);

  /// From processes made elsewhere.
  explicit Surrogate(std::vector<std::optional<GaussianProcess>> processes)
      : processes_(std::move(processes)) {}

  [[nodiscard]] std::size_t size() const { return processes_.size(); }

  /// SI; NaN for a measurement that no run has observed.
  [[nodiscard]] Belief at(std::size_t measurement, std::span<const double> point) const;
  [[nodiscard]] const std::optional<GaussianProcess>& process(std::size_t measurement) const {
    return processes_[measurement];
  }

  /// With runs pending at these points; `variance` of one run, per measurement.
  [[nodiscard]] Surrogate believing(std::span<const UnitPoint> points,
                                    std::span<const double> variance) const;

 private:
  std::vector<std::optional<GaussianProcess>> processes_;
  int refits_ = 0;
};

}  // namespace repose::calibrator
