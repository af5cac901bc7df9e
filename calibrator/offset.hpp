/// Offset: what the confirming fidelity adds to the searching one, per measurement.
///
/// Each site where both are known gives an estimate: from paired runs (same seed, both fidelities),
/// or from confirming runs against the emulator. They are averaged by inverse variance, where a
/// site that disagrees with the latest one counts for less by as much as it disagrees:
///
///   d = sum_i w_i d_i / sum_i w_i,   1 / w_i = v_i + max(0, (d_i - d_L)^2 - v_i - v_L)
///
///   d_i  estimate at site i, SI    v_i  its variance, SI^2    L  the site confirmed last
///
/// so that an offset that changes over the cube follows the search. The bracket is the moment
/// estimate of a between-site variance (DerSimonian & Laird 1986, Controlled Clinical Trials 7,
/// 177-188).
#pragma once

#include <vector>

#include "calibrator/ledger.hpp"
#include "calibrator/surrogate.hpp"

namespace repose::calibrator {

struct Offset {
  std::vector<double> value;     ///< SI, confirm fidelity minus search fidelity
  std::vector<double> variance;  ///< SI squared, of that
};

/// Zero and exact where there is one fidelity only; `latest` is the index of the site confirmed
/// last.
Offset learn_offset(const Ledger& ledger, const Surrogate& surrogate, std::size_t latest);

}  // namespace repose::calibrator
