/// Tolerated: the calibrated model where it fits best once tolerances weigh as much as the errors
/// of the laboratory.
///
/// A calibration follows the laboratory alone, as closely as its errors allow. Where codes differ by
/// more than the laboratory errs, its best set makes up for that with wrong parameters, and another
/// set of the same model may be the likelier. Nothing is run: it is looked for on the calibration's
/// own runs, as a diagnosis does.
#pragma once

#include <optional>
#include <string>

#include "calibrator/calibration.hpp"
#include "calibrator/diagnosis/tolerance.hpp"
#include "calibrator/fit.hpp"
#include "engine/parameter_set.hpp"

namespace repose::calibrator {

struct Tolerated {
  engine::ParameterSet parameters;  ///< complete
  double misfit = 0.0;              ///< Q with the tolerances, the emulator's error included
  double freedom = 0.0;
  double p = 1.0;  ///< that a right model misses by so much
};

/// Nothing where the calibration has too few runs to learn from.
std::optional<Tolerated> tolerated(const Calibration& calibration,
                                   const Fit& fit,
                                   const Tolerances& stated);

/// Whether that fits, and where it lies.
std::string sentence_of(const Calibration& calibration, const Tolerated& tolerated);

}  // namespace repose::calibrator
