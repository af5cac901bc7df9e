/// What the data determine: intervals of the parameters, and the directions that were learnt.
///
///   Q(u)    = p(u) + sum_j [ (mu_j(u) - y_j)^2 / v_j + log v_j ],   v_j = sd_j(u)^2 + sigma_j^2
///   PL_k(t) = min over u with u_k = t of Q(u);   95 % interval: PL_k(t) <= min Q + 3.84
///   J_jk    = (d mu_j / d u_k) / sqrt(sd_j^2 + sigma_j^2),   F = J'J,   posterior (P + F)^-1
///   P_kk    = 12 + (dx_k / du_k / s_k)^2, the second term where parameter k has a prior
///
///   mu, sd  emulator   y, sigma  target   3.84 = 95 % point of chi-squared, one degree of freedom
///   12      inverse variance of the uniform prior on [0, 1]   p  misfit of the priors
///   s       standard deviation of a prior
///
/// A direction (eigenvector of P^-1/2 F P^-1/2, eigenvalue lambda) has posterior over prior
/// (1 + lambda)^-1/2, and is learnt at 1/2 or less, that is from lambda = 3.
///
/// Source: profile likelihood, Venzon & Moolgavkar 1988 (Applied Statistics 37, 87-94); Raue et al.
///         2009 (Bioinformatics 25, 1923-1929).
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "calibrator/fit.hpp"
#include "calibrator/proposal.hpp"

namespace repose::calibrator {

/// In the coordinate of one parameter.
struct Interval {
  double lower = 0.0;
  double upper = 1.0;
  bool lower_at_bound = true;  ///< ends where the search does: at a bound, or at a constraint
  bool upper_at_bound = true;
};

/// The profile-likelihood interval of every parameter.
std::vector<Interval> profile_intervals(const Outlook& outlook, const UnitPoint& best);

/// The diagonal of P, and F.
Eigen::VectorXd prior_precision(const Outlook& outlook, const UnitPoint& best);
Eigen::MatrixXd information(const Outlook& outlook, const UnitPoint& best);

struct Learnt {
  std::vector<Direction> directions;  ///< best-learnt first
  std::vector<double> share;          ///< 1 - posterior variance / prior variance, per parameter
};
Learnt learnt_directions(const Outlook& outlook, const UnitPoint& best);

}  // namespace repose::calibrator
