/// Chi-squared distribution: the chance of a misfit at least so large where nothing is missing.
#pragma once

namespace repose::calibrator {

/// P(X >= value), X chi-squared with that many degrees of freedom; they may be a fraction.
double chi_squared_tail(double value, double freedom);

}  // namespace repose::calibrator
