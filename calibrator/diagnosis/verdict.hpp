/// The rules by which a diagnosis decides, and its sentence.
///
///   adequate     p_named >= 0.03, p_unnamed >= 0.015 and p_misfit >= 0.005: 5 % in all; and what is
///                held out is missed by no more than has p_held_out >= 0.005
///   A, B, C, D   margin M = deviance of the best excuse - of the best refit: A above 6 where more
///                than one apparatus asks for the effects, B within or where one does, C below -6
///                where the excuse fits better; D where no misfit has p >= 0.02
///   plausible    refits whose deviance is within 6 of the best
///
/// Source: the error rates of these numbers on a stand-in, tests/calibrator/diagnosis.
#pragma once

#include <string>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/diagnosis/diagnosis.hpp"
#include "calibrator/diagnosis/screen.hpp"

namespace repose::calibrator {

/// Of two deviances that the data cannot tell apart.
inline constexpr double close_deviances = 6.0;

/// Where no fitted measurement was observed often enough to learn from.
void refuse(Diagnosis& diagnosis);

bool adequate(const Diagnosis& diagnosis);

/// Whether no single effect fits, nor an excuse.
bool wants_pairs(const Diagnosis& diagnosis);

/// Detectable and excluded strengths, and the status, from what one effect's trace is worth
/// (power_of, screen.hpp).
void weigh(EffectFinding& finding, double power, std::size_t effects);

/// Effects whose traces are the same once the free parameters have done their best.
void find_families(const Screen& screen,
                   const std::vector<std::size_t>& screened,
                   Diagnosis& diagnosis);

/// Verdict, grade, plausible set and sentence, from all that was found. `sole_witness`: the one
/// apparatus that asks for the best refit's effects; empty: others do, too.
void conclude(const Calibration& calibration,
              const std::string& sole_witness,
              Diagnosis& diagnosis);

}  // namespace repose::calibrator
