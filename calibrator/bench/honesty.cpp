#include "calibrator/bench/honesty.hpp"

#include <cmath>
#include <span>
#include <utility>

#include "calibrator/bench/bench_run.hpp"
#include "calibrator/calibrate.hpp"
#include "calibrator/misfit.hpp"
#include "engine/random.hpp"

namespace repose::calibrator::bench {
namespace {

constexpr std::uint64_t drawing = 7;  // apart from the streams of the studies themselves

/// The truth anywhere in the cube, the targets measured there.
AnalyticStudy as_measured(AnalyticStudy study, std::uint64_t seed) {
  engine::Random random(seed, engine::Purpose::grain_orientation, drawing);
  for (double& u : study.truth) u = random.uniform();
  const std::vector<double> exact = study.response(study.truth);
  for (std::size_t j = 0; j < exact.size(); ++j) {
    study.calibration.measurements[j].value = exact[j] + study.sigma[j] * random.normal();
  }
  return study;
}

/// The misfit of the mean of eight fresh runs, counted as a fit counts its own.
double fresh_misfit(const AnalyticStudy& study, const engine::ParameterSet& best) {
  constexpr int runs = 8;
  const auto& measurements = study.calibration.measurements;
  const Suite suite(measurements);
  std::vector<engine::Trial> trials;
  for (int r = 0; r < runs; ++r) {
    suite.append_trials(
        best, study.calibration.budget.fidelity, 900'000U + static_cast<std::uint64_t>(r), trials);
  }
  const auto evaluations = evaluator(study)(trials);
  double misfit = 0.0;
  for (std::size_t j = 0; j < measurements.size(); ++j) {
    double sum = 0.0, squares = 0.0;
    for (const engine::Evaluation& evaluation : evaluations) {
      const double value = suite.read(std::span(&evaluation, 1))[j];
      sum += value;
      squares += value * value;
    }
    const double mean = sum / runs;
    const double variance = (squares - runs * mean * mean) / (runs - 1) / runs;
    const double z = (mean - measurements[j].value) /
                     std::hypot(standard_uncertainty(measurements[j]), std::sqrt(variance));
    misfit += z * z;
  }
  return misfit;
}

}  // namespace

Honesty honesty_of_case(std::size_t index, int studies) {
  Honesty result;
  double shown = 0.0, fresh = 0.0;
  int in_posterior = 0, in_profile = 0;
  for (int s = 1; s <= studies; ++s) {
    const auto seed = static_cast<std::uint64_t>(s);
    const AnalyticStudy study = as_measured(study_of_case(index, Method::repose, seed), seed);
    const Fit fit = calibrate(study.calibration, evaluator(study));
    if (fit.posterior.quantiles.empty()) continue;
    ++result.studies;
    for (std::size_t k = 0; k < study.truth.size(); ++k) {
      const double truth = study.truth[k];  // the parameters of the bench are their coordinates
      ++result.parameters;
      const auto& quantiles = fit.posterior.quantiles[k];
      if (quantiles.front() <= truth && truth <= quantiles.back()) ++in_posterior;
      if (fit.parameters[k].lower <= truth && truth <= fit.parameters[k].upper) ++in_profile;
    }
    shown += fit.misfit;
    fresh += fresh_misfit(study, fit.best);
    if (fit.stop != StopReason::hit) continue;
    ++result.declared;
    if (!truly_hits(study, fit.best)) ++result.false_hits;
  }
  if (result.parameters == 0) return result;
  result.posterior_90 = static_cast<double>(in_posterior) / result.parameters;
  result.profile_95 = static_cast<double>(in_profile) / result.parameters;
  result.misfit_ratio = shown / fresh;
  return result;
}

namespace {

/// The same experiments with another truth.
AnalyticStudy with_truth(AnalyticStudy study, std::uint64_t seed) {
  study.truth = random_truth(study.truth.size(), seed);
  const std::vector<double> target = study.response(study.truth);
  for (std::size_t j = 0; j < target.size(); ++j) {
    study.calibration.measurements[j].value = target[j];
  }
  study.calibration.seed = seed;
  return study;
}

}  // namespace

WarmStart warm_start_of_case(std::size_t index, int seeds, int stored) {
  WarmStart result;
  for (int s = 1; s <= seeds; ++s) {
    const auto seed = static_cast<std::uint64_t>(s);
    const AnalyticStudy study = study_of_case(index, Method::repose, seed);
    std::vector<engine::Evaluation> kept;
    for (std::uint64_t other = 1; kept.size() < static_cast<std::size_t>(stored); ++other) {
      const AnalyticStudy earlier = with_truth(study, 1000 * seed + other);
      const Evaluator answers = evaluator(earlier);
      calibrate(earlier.calibration, [&](std::span<const engine::Trial> trials) {
        auto evaluations = answers(trials);
        kept.insert(kept.end(), evaluations.begin(), evaluations.end());
        return evaluations;
      });
    }
    kept.resize(static_cast<std::size_t>(stored));
    const AnalyticStudy later = with_truth(study, 1000 * seed);
    result.evaluations.push_back(run(later, known_runs(later.calibration, kept)).solved_at);
  }
  return result;
}

}  // namespace repose::calibrator::bench
