/// Next measurement: which one would tell rival explanations apart?
///
///   G_q = sum_{i<j} w_i w_j min(12, t_ijq),   t_ijq = (m_iq - m_jq)^2 / (s_q^2 + V_iq + V_jq)
///
///   q  a measurement that could be made     i, j  rivals     w  their weights, of sum 1
///   m, V  mean and variance of what a rival predicts over its draws, the scatter of runs included
///   s  standard error that the measurement would have
///
/// Each rival has been fitted to the data there are, so that what they all predict alike tells
/// nothing. 12: more evidence than that is not needed. Only the candidates are simulated.
///
/// Source: Box & Hill 1967, Technometrics 9, 57-71; Hunter & Reiner 1965, Technometrics 7, 307-323.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/diagnosis/diagnosis.hpp"
#include "calibrator/evaluator.hpp"
#include "calibrator/measurement.hpp"

namespace repose::calibrator {

/// An explanation, as parameter sets that it allows.
struct Rival {
  std::vector<engine::ParameterSet> draws;
  double weight = 1.0;
};

/// A measurement that could be made; its value is open.
struct Candidate {
  Measurement measurement;    ///< its standard error: SI, and to be expected
  double relative_error = 0;  ///< of its size, in quadrature to that
};

/// What the virtual experiments could measure besides the study's own: every experiment at its
/// defaults, and at other heights, speeds, stresses and sizes; for a study of single grains no
/// beds, which would cost a thousand times its own runs. The error is what the study's own readings
/// of the observable have, else what is usual, and the tolerance of the code.
std::vector<Candidate> candidates_of(const Calibration& calibration, const Tolerances& stated);

/// The candidates in the order of what they would settle, best first; those that would settle
/// nothing are left out.
std::vector<DecidingMeasurement> weigh_candidates(const Calibration& calibration,
                                                  std::span<const Candidate> candidates,
                                                  std::span<const Rival> rivals,
                                                  const Evaluator& evaluator);

}  // namespace repose::calibrator
