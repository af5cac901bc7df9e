/// The joint posterior of the free parameters, sampled on the emulator.
///
///   log P(u) = log p(u) - 1/2 sum_j [ (mu_j - y_j)^2 / v_j + log v_j ],   v_j = sd_j^2 + sigma_j^2
///   stretch:   walker k of one half moves to u_j + z (u_k - u_j), j of the other half, z from
///              [1/2, 2] with density ~ 1 / sqrt z; taken with chance min(1, z^(d-1) P' / P)
///
///   mu, sd  emulator   y, sigma  target   p  prior   d  parameters
///
/// Two ensembles of 32 walkers that know nothing of each other, doubled in length until split R-hat
/// between them <= 1.01 and 1000 effective samples of every parameter, or 3200 steps; the first
/// half is left out. Source: affine-invariant ensemble, Goodman & Weare 2010 (Comm. App. Math.
/// Comput. Sci. 5, 65-80); R-hat and effective samples, Gelman et al. 2013 (BDA3, 11.4-11.5), an
/// ensemble being a chain for the first, a walker for the second.
#pragma once

#include "calibrator/fit.hpp"
#include "calibrator/proposal.hpp"

namespace repose::calibrator {

/// `best` is where some of the walkers start.
Posterior sample_posterior(const Outlook& outlook, const UnitPoint& best);

/// Convergence of one coordinate; every chain is as long, an even number of draws.
struct Convergence {
  double r_hat = 1.0;
  double effective = 0.0;  ///< samples
};
Convergence convergence(const std::vector<std::vector<double>>& chains);

}  // namespace repose::calibrator
