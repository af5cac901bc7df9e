/// What to measure next: which further measurement would teach most about the free parameters.
///
///   gain_c = 1/2 log det(P + F + J_c' J_c / v_c) - 1/2 log det(P + F)
///
///   P, F  prior precision and information, calibrator/uncertainty.hpp     J_c  d mu_c / d u
///   v_c   variance of the emulator and of the measurement
///
/// Candidates: what the runs observe and nobody measured, at the median relative standard error of
/// the study; and each fitted measurement again, with half its standard error. Neither needs a
/// simulation. Source: Bayesian D-optimality for a linear model, Chaloner & Verdinelli 1995 (Stat.
/// Science 10, 273-304).
#pragma once

#include <vector>

#include "calibrator/fit.hpp"
#include "calibrator/proposal.hpp"

namespace repose::calibrator {

/// The three of largest gain, best first.
std::vector<NextMeasurement> next_measurements(const Outlook& outlook, const UnitPoint& best);

}  // namespace repose::calibrator
