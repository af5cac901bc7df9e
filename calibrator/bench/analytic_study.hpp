/// Studies whose experiments are formulas: a calibration, the evaluator that answers it, and the
/// truth. What a method of calibration is judged by, since there the truth is known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/evaluator.hpp"
#include "calibrator/search_space.hpp"

namespace repose::calibrator::bench {

using Response = std::function<std::vector<double>(std::span<const double>)>;

struct AnalyticStudy {
  Response response;          ///< noise-free observables at a point of the cube
  std::vector<double> sigma;  ///< standard errors of the measurements
  UnitPoint truth;
  double noise = 0.5;  ///< scatter of a run over sigma, at the cube's centre
  /// Scatter of a run at a point, relative to that at the centre.
  std::function<double(std::span<const double>)> noise_shape = [](auto) { return 1.0; };
  std::function<bool(std::span<const double>)> fails = [](auto) { return false; };
  Response draft_bias = {};  ///< added to the observables at draft fidelity
  Calibration calibration = {};
};

/// The name of free parameter k.
std::string parameter(std::size_t k);

/// Fills in the question: parameters on [0, 1], exact targets at the truth.
AnalyticStudy ask(AnalyticStudy study, std::uint64_t seed, int evaluations, int batch);

/// One trial, and all of a batch. The evaluator refers to the study, which must outlive it.
engine::Evaluation answer(const AnalyticStudy& study, const engine::Trial& trial);
Evaluator evaluator(const AnalyticStudy& study);

/// Whether a set is truly within one standard error of every target.
bool truly_hits(const AnalyticStudy& study, const engine::ParameterSet& parameters);

/// Restitution, friction, rolling friction, size spread and log modulus, over the cube, against
/// bulk density, poured repose, discharge, drum slow and fast, log stiffness: made-up formulas that
/// bend, saturate and couple as those of a granular bed do.
std::vector<double> granular_response(std::span<const double> u);

/// Within [0.1, 0.9] on each axis.
UnitPoint random_truth(std::size_t dimensions, std::uint64_t seed);

/// Two observables (the first), four (with discharge and fast drum) or all six of that response.
/// `noise`: scatter of a run over the standard errors, at medium friction.
AnalyticStudy granular(
    std::size_t observables, double noise, std::uint64_t seed, int evaluations, int batch);

/// Eight parameters, eight responses: a random linear part (deviation 4) and 3 sin(F u + p), the
/// entries of F standard normal.
AnalyticStudy eight_by_eight(std::uint64_t seed, int evaluations, int batch);

}  // namespace repose::calibrator::bench
