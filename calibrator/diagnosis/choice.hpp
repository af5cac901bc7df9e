/// Choice: which models are worth a refit.
#pragma once

#include <vector>

#include "calibrator/diagnosis/diagnosis.hpp"
#include "calibrator/diagnosis/models.hpp"
#include "calibrator/diagnosis/screen.hpp"

namespace repose::calibrator {

/// The three testable suspects of the highest scores; of a family, whose traces are one, the first
/// stands for all unless there is room. `screened`: the suspects of the screen's departures.
std::vector<Additions> best_singles(const Screen& screen,
                                    const std::vector<std::size_t>& screened,
                                    const Diagnosis& diagnosis);

/// The two pairs of largest one-step gain, and the best with the best single effect.
std::vector<Additions> best_pairs(const Screen& screen,
                                  const std::vector<std::size_t>& screened,
                                  const Diagnosis& diagnosis);

}  // namespace repose::calibrator
