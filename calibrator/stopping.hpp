/// When to stop: the chance that the recommended point would pass the test of a hit, that anything
/// better is left, and how implausible even the best point is.
///
///   hit:          |zbar_j| + s_j / (sigma_j sqrt(R)) <= 1 for every fitted j, R fresh replicates
///   better left:  P(min_u Q(u) < Q(recommended) - eps),
///                 eps = max(0.5, 0.05 m, 0.2 E Q(recommended))
///   implausible:  I(u) = max_j |mu_j - y_j| / sqrt(sd_j^2 + s_j^2 / R + sigma_j^2) > 3 for all u;
///                 the second largest where m >= 6
///
///   s_j  scatter of one run     sigma_j  standard uncertainty of the measurement
///   m    fitted measurements    mu, sd   emulator
///
/// Source: probabilistic stopping, Wilson 2024 (arXiv 2402.16811); implausibility, Bower, Goldstein
///         & Vernon 2010 (Bayesian Analysis 5, 619-670).
#pragma once

#include <span>
#include <vector>

#include "calibrator/proposal.hpp"

namespace repose::calibrator {

/// Fresh replicates that confirm a point: clamp(ceil(max_j (s_j / (0.3 sigma_j))^2), 4, 8).
int confirming_replicates(const Ledger& ledger);

/// Whether fresh replicates are within one standard error of every fitted measurement.
bool is_hit(const Ledger& ledger, std::span<const SiteRun> replicates);

/// Whether more of them could still be: none of the means is two of its standard errors outside.
bool may_be_hit(const Ledger& ledger, std::span<const SiteRun> replicates);

/// The chance that `replicates` runs at the point would be a hit, the observables independent.
double probability_of_hit(const Outlook& outlook, const UnitPoint& point, int replicates);

/// P(better left), from 128 joint draws of the emulators on the most promising of 2000 points.
double probability_of_better(const Outlook& outlook, const UnitPoint& recommended);

/// min over u of I(u).
double least_implausibility(const Outlook& outlook, const UnitPoint& recommended);

}  // namespace repose::calibrator
