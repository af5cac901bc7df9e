/// What to measure next: which further measurement would teach most about the free parameters.
///
///   gain_c = sum over i of P_ii (inv(P + F) - inv(P + F + J_c' J_c / v_c))_ii
///
///   P, F  prior precision and information, calibrator/uncertainty.hpp     J_c  d mu_c / d u
///   v_c   variance of the emulator and of the measurement
///
/// That is the share of each parameter's prior variance that it would take away. By the determinant
/// of P + F, halving the error of what is known to a hundredth would count as much as learning half
/// of what is open.
///
/// Candidates: what the runs observe and nobody measured, at the median relative standard error of
/// the study; and each fitted measurement again, with half its standard error. Neither needs a
/// simulation. Source: Bayesian A-optimality for a linear model, Chaloner & Verdinelli 1995 (Stat.
/// Science 10, 273-304).
#pragma once

#include <vector>

#include "calibrator/fit.hpp"
#include "calibrator/proposal.hpp"

namespace repose::calibrator {

/// The three of largest gain, best first; none that would take away less than a hundredth.
std::vector<NextMeasurement> next_measurements(const Outlook& outlook, const UnitPoint& best);

}  // namespace repose::calibrator
