/// The answer, put together from what a search ended with.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "calibrator/fit.hpp"
#include "calibrator/proposal.hpp"

namespace repose::calibrator {

/// The recommended point as fresh replicates found it, and what had been promised.
struct Confirmation {
  std::size_t site = 0;
  std::vector<SiteRun> runs;
  std::vector<Belief> promised;  ///< SI, at the confirming fidelity
};

/// Whether the fresh replicates are what the emulator had led to expect.
bool promise_kept(const Outlook& outlook, const Confirmation& confirmation);

/// Every measurement against its confirmed prediction, and the misfit that follows.
void fill_predictions(const Outlook& outlook, const Confirmation& confirmation, Fit& fit);

/// Best values, intervals, the joint posterior, what was learnt and what to measure next.
void fill_parameters(const Outlook& outlook, const UnitPoint& best, Fit& fit);

/// A fit that came to nothing, and why.
Fit failure(Ledger& ledger, std::string remark);

}  // namespace repose::calibrator
