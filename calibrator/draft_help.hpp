/// What draft runs tell of the dearer ones, and whether that is worth anything.
///
///   f_S = rho f_D + delta + e,   by least squares over the points run at both, with equal seeds
///   R^2 = 1 - (sum e^2 / (n - 2)) / (sum (f_S - mean)^2 / (n - 1))
///
///   f_S, f_D  one observable at the search's fidelity and at draft, SI    n  points run at both
///
/// They help an observable where R^2 >= 0.9 and a draft costs at most 0.2 of the other; else they
/// are left out, and that is said. Source: autoregressive levels, Kennedy & O'Hagan 2000
/// (Biometrika 87, 1-13), with a constant difference; the limits, calibration.md 7.11.
#pragma once

#include <string>
#include <vector>

#include "calibrator/ledger.hpp"

namespace repose::calibrator {

struct DraftHelp {
  double slope = 1.0;   ///< rho
  double offset = 0.0;  ///< delta, SI
  double r_squared = 0.0;
  double cost = 1.0;  ///< of a draft over that of the other
  bool proven = false;
  double residual = 0.0;  ///< SI squared, of e
  double mean = 0.0;      ///< SI, of f_D over the pairs
  double spread = 0.0;    ///< SI squared, sum of squares about it
  int pairs = 0;

  /// What a draft run foretells of the other, SI, and the variance of that.
  [[nodiscard]] double value(double draft) const { return slope * draft + offset; }
  [[nodiscard]] double variance(double draft) const;
};

/// One per measurement; none where nothing was run at draft beside the search.
std::vector<DraftHelp> learn_draft_help(const Ledger& ledger);

/// What came of the drafts, in sentences.
std::vector<std::string> draft_remarks(const Ledger& ledger);

}  // namespace repose::calibrator
