/// ModelFit: one model (the calibrated one, or it with effects added) at its best on an emulator,
/// by the most probable point of a box.
///
///   F(x) = |L^-1 (y - f(x))|^2 + sum_k ((x_k - m_k) / s_k)^2,   L L' = Sigma
///
///   x  coordinates of the free parameters, then strengths     y  targets     f  emulator's mean
///   Sigma  of the targets and of the emulator at x            m, s  weak normal prior
///
/// Search: Levenberg-Marquardt, projected on the box (Kanzow, Yamashita & Fukushima 2004, J.
/// Comput. Appl. Math. 172, 375-397).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace repose::calibrator {

/// What a model predicts of the targets.
struct Predictor {
  std::function<Eigen::VectorXd(const Eigen::VectorXd& x)> mean;
  std::function<Eigen::MatrixXd(const Eigen::VectorXd& x)> jacobian;
};

/// Where a model may lie, and where it is thought to.
struct ModelSpace {
  Eigen::VectorXd lower, upper;
  Eigen::VectorXd centre, precision;  ///< of the prior: m and 1 / s
};

struct ModelFit {
  Eigen::VectorXd at;
  Eigen::VectorXd residuals;         ///< whitened: L^-1 (y - f)
  Eigen::MatrixXd jacobian;          ///< whitened: L^-1 df/dx
  Eigen::MatrixXd whitener;          ///< L^-1
  double objective = 0.0;            ///< F
  double misfit = 0.0;               ///< Q, sum of squared residuals
  double deviance = 0.0;             ///< Q + log det Sigma: -2 log likelihood but for a constant
  double freedom = 0.0;              ///< targets less the effective number of fitted parameters
  std::vector<Eigen::Index> inside;  ///< coordinates that no bound holds
};

/// The best of the searches from each start, Sigma held.
ModelFit fit_model(const Predictor& predictor,
                   const Eigen::VectorXd& targets,
                   const Eigen::MatrixXd& covariance,
                   const ModelSpace& space,
                   std::span<const Eigen::VectorXd> starts);

}  // namespace repose::calibrator
