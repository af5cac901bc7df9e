/// Covariance of measurements as the model sees them: the laboratory's errors, and the tolerance.
///
/// Readings of one observable share most of what two right codes differ by, but not all: a drum at
/// 15, 30 and 60 rpm was 5 and 8 % steeper and 6 % flatter than another code's.
///
///   Cov(t_i, t_j) = 0.75 tau_i tau_j,  i != j      Var(t_i) = max(tau_i, a_i)^2
///
///   tau_j  spread x size of y_j     a_j  allowance of the measurement, its own
#pragma once

#include <span>

#include <Eigen/Core>

#include "calibrator/diagnosis/tolerance.hpp"

namespace repose::calibrator {

/// Share of the square of a tolerance that readings of one observable have in common.
inline constexpr double shared_tolerance = 0.75;

/// Standard errors, and the tolerances with what they share; SI.
Eigen::MatrixXd covariance_of(std::span<const Measurement> measurements, const Tolerances& stated);

/// How far each measurement's variance is known, in degrees of freedom: of it only the standard
/// error was estimated, and only where repetitions are stated; infinite where all of it is known.
///
///   nu_j = (n_j - 1) Sigma_jj^2 / s_j^4
///
///   n_j  repetitions     s_j  standard error     Sigma_jj  the whole variance
///
/// Source: Welch 1947, Biometrika 34, 28-35; Satterthwaite 1946, Biometrics Bull. 2, 110-114.
Eigen::VectorXd freedom_of(std::span<const Measurement> measurements,
                           const Eigen::VectorXd& variance);

}  // namespace repose::calibrator
