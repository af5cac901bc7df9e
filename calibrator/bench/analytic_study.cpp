#include "calibrator/bench/analytic_study.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "engine/random.hpp"

namespace repose::calibrator::bench {

std::string parameter(std::size_t k) { return "toy.u" + std::to_string(k); }

AnalyticStudy ask(AnalyticStudy study, std::uint64_t seed, int evaluations, int batch) {
  Calibration& c = study.calibration;
  c.name = "toy";
  c.seed = seed;
  c.budget.evaluations = evaluations;
  c.budget.batch = batch;
  for (std::size_t k = 0; k < study.truth.size(); ++k) {
    c.free.push_back({engine::make_key(parameter(k), {}), 0.0, 1.0, {}, {}});
  }
  const std::vector<double> target = study.response(study.truth);
  for (std::size_t j = 0; j < target.size(); ++j) {
    Measurement m;
    m.experiment.name = "toy";
    m.observable = "y" + std::to_string(j);
    m.value = target[j];
    m.standard_error = study.sigma[j];
    c.measurements.push_back(std::move(m));
  }
  return study;
}

engine::Evaluation answer(const AnalyticStudy& study, const engine::Trial& trial) {
  const UnitPoint u = SearchSpace(study.calibration).coordinates(trial.parameters);
  engine::Evaluation evaluation{trial, {}, {}};
  if (study.fails(u)) {
    evaluation.outcome =
        engine::Failure{engine::FailureKind::did_not_rest, "the heap still creeps", 1.0};
    return evaluation;
  }
  std::vector<double> values = study.response(u);
  std::vector<engine::Observation> observations;
  engine::Random random(trial.seed, engine::Purpose::grain_position);
  const double shape = study.noise * study.noise_shape(u);
  for (std::size_t j = 0; j < values.size(); ++j) {
    double value = values[j] + shape * study.sigma[j] * random.normal();
    if (trial.experiment.fidelity == engine::Fidelity::draft && study.draft_bias) {
      value += study.draft_bias(u)[j];
    }
    observations.push_back({"y" + std::to_string(j), value});
  }
  evaluation.outcome = std::move(observations);
  return evaluation;
}

Evaluator evaluator(const AnalyticStudy& study) {
  return [&study](std::span<const engine::Trial> trials) {
    std::vector<engine::Evaluation> evaluations;
    for (const engine::Trial& trial : trials) evaluations.push_back(answer(study, trial));
    return evaluations;
  };
}

bool truly_hits(const AnalyticStudy& study, const engine::ParameterSet& parameters) {
  const UnitPoint u = SearchSpace(study.calibration).coordinates(parameters);
  const std::vector<double> values = study.response(u);
  for (std::size_t j = 0; j < values.size(); ++j) {
    if (std::abs(values[j] - study.calibration.measurements[j].value) > study.sigma[j])
      return false;
  }
  return true;
}

std::vector<double> granular_response(std::span<const double> u) {
  const double e = 0.2 + 0.7 * u[0];
  const double mu = 0.1 + 0.8 * u[1];
  const double mu_r = 0.005 * std::pow(100.0, u[2]);
  const double w = 0.6 * u[3];
  const double g = 6.0 + 2.0 * u[4];
  const double a = 1.0 - std::exp(-mu / 0.25);
  const double b = 1.0 - std::exp(-mu_r / 0.08);
  const double slow = 14.0 + 17.0 * a * (0.7 + 0.5 * b) + w;
  return {1.2 * (0.635 - 0.075 * a - 0.035 * a * b + 0.045 * std::pow(w, 1.5) -
                 0.012 * (1.0 - e) * (1.0 - e) - 0.003 * (g - 7.0)),
          10.0 + 14.0 * a + 16.0 * a * b * (1.0 + 0.3 * b) - 1.5 * w + 2.0 * (1.0 - e) * a,
          1.0 - 0.25 * a - 0.12 * a * b - 0.08 * w + 0.03 * (e - 0.5),
          slow,
          slow + 6.0 * (1.0 - e) * (0.5 + a),
          g - 7.0 + 0.3 * a - 0.2 * w};
}

UnitPoint random_truth(std::size_t dimensions, std::uint64_t seed) {
  engine::Random random(seed, engine::Purpose::grain_size);
  UnitPoint truth(dimensions);
  for (double& u : truth) u = random.uniform(0.1, 0.9);
  return truth;
}

namespace {

/// The first ones; of four, the last is the fast drum.
std::vector<double> choose(std::vector<double> all, std::size_t observables) {
  if (observables == 4) all[3] = all[4];
  all.resize(observables);
  return all;
}

}  // namespace

AnalyticStudy granular(
    std::size_t observables, double noise, std::uint64_t seed, int evaluations, int batch) {
  AnalyticStudy study;
  study.response = [observables](std::span<const double> u) {
    return choose(granular_response(u), observables);
  };
  study.sigma = choose({0.0075, 1.0, 0.015, 1.0, 1.0, 0.05}, observables);
  study.truth = random_truth(5, seed);
  study.noise = noise;
  study.noise_shape = [](std::span<const double> u) { return 0.5 + u[1]; };
  return ask(std::move(study), seed, evaluations, batch);
}

AnalyticStudy eight_by_eight(std::uint64_t seed, int evaluations, int batch) {
  constexpr std::size_t n = 8;
  engine::Random random(seed, engine::Purpose::grain_velocity);
  std::vector<double> linear(n * n);
  std::vector<double> frequency(n * n);
  std::vector<double> phase(n);
  for (double& x : linear) x = 4.0 * random.normal();
  for (double& x : frequency) x = random.normal();
  for (double& x : phase) x = random.uniform(0.0, 2.0 * std::numbers::pi);
  AnalyticStudy study;
  study.response = [linear, frequency, phase](std::span<const double> u) {
    std::vector<double> y(n);
    for (std::size_t j = 0; j < n; ++j) {
      double argument = phase[j];
      for (std::size_t k = 0; k < n; ++k) {
        y[j] += linear[j * n + k] * u[k];
        argument += frequency[j * n + k] * u[k];
      }
      y[j] += 3.0 * std::sin(argument);
    }
    return y;
  };
  study.sigma.assign(n, 1.0);
  study.truth = random_truth(n, seed);
  study.noise_shape = [](std::span<const double> u) { return 0.5 + u[1]; };
  return ask(std::move(study), seed, evaluations, batch);
}

}  // namespace repose::calibrator::bench
