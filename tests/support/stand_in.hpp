/// A stand-in for a suite of experiments, to measure how often a diagnosis is right: problems whose
/// truth is known, over the made-up responses of stand_in_response.hpp.
///
/// Observables are logarithms, so that noise is relative.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "calibrator/calibration.hpp"
#include "calibrator/design.hpp"
#include "calibrator/diagnosis/covariance.hpp"
#include "calibrator/diagnosis/diagnose.hpp"
#include "calibrator/diagnosis/question.hpp"
#include "calibrator/diagnosis/screen.hpp"
#include "calibrator/evaluator.hpp"
#include "calibrator/fit.hpp"
#include "calibrator/misfit.hpp"
#include "calibrator/search_space.hpp"
#include "engine/random.hpp"
#include "tests/support/stand_in_response.hpp"

namespace repose::stand_in {

/// How another code would answer: an offset and slopes for every kind of observable, and a factor
/// on the response to effects.
struct OtherCode {
  double spread = 0.0;
  std::uint64_t seed = 1;

  [[nodiscard]] double operator()(const std::array<double, 5>& u,
                                  const Hidden& hidden,
                                  const Reading& reading) const {
    const double own = response(u, hidden, reading.observable, reading.condition);
    if (spread == 0.0) return own;
    const double base = response(u, {}, reading.observable, reading.condition);
    const auto place = observables().find(reading.observable);
    const auto index =
        static_cast<std::uint64_t>(std::distance(observables().begin(), place)) + 100 * seed;
    engine::Random random(seed, engine::Purpose::grain_size, index);
    double shift = spread * 0.8 * random.normal();
    for (const double x : u) shift += 1.5 * spread * 0.6 * random.normal() * (x - 0.5);
    return base + shift + (own - base) * std::exp(0.15 * random.normal());
  }
};

/// One problem: its truth, its measurements, and the calibration that its user would have made.
struct Problem {
  std::array<double, 5> truth{};
  Hidden hidden;
  calibrator::Calibration calibration;
  calibrator::Fit fit;
  std::vector<calibrator::Suspect> suspects;
  Eigen::MatrixXd covariance;  ///< what the diagnosis is told
  Eigen::VectorXd freedom;
};

inline engine::ParameterKey parameter(std::size_t k) {
  return engine::make_key("stand_in.u" + std::to_string(k), {});
}
inline engine::ParameterKey strength(std::string_view effect) {
  return engine::make_key("stand_in." + std::string(effect), {});
}

inline calibrator::Evaluator evaluator(const Problem& problem) {
  return [&problem](std::span<const engine::Trial> trials) {
    std::vector<engine::Evaluation> evaluations;
    for (const engine::Trial& trial : trials) {
      std::array<double, 5> u{};
      for (std::size_t k = 0; k < u.size(); ++k) u[k] = trial.parameters.get_or(parameter(k), 0.0);
      Hidden on;
      for (const std::string_view effect : effects) {
        const double phi = trial.parameters.get_or(strength(effect), 0.0);
        if (phi != 0.0) on[std::string(effect)] = phi;
      }
      engine::Evaluation evaluation{trial, {}, {}};
      std::vector<engine::Observation> seen;
      std::uint64_t stream = 0;
      for (const auto& [name, observable] : observables()) {
        ++stream;
        if (observable.rig != trial.experiment.name) continue;
        // Every rig has its own chance.
        std::uint64_t index = stream;
        for (const auto& [setting, value] : trial.experiment.settings) {
          index = index * 1000003 + static_cast<std::uint64_t>(std::llround(1e4 * value));
        }
        engine::Random random(trial.seed, engine::Purpose::grain_position, index);
        double scatter = observable.simulated;
        if (observable.kind == "reb" && on.contains("shape")) {
          scatter *= 3.0 * std::min(on["shape"], 1.0);  // tumbling grains rebound anyhow
        }
        seen.push_back(
            {name, response(u, on, name, trial.experiment.settings) + scatter * random.normal()});
      }
      evaluation.outcome = std::move(seen);
      evaluations.push_back(std::move(evaluation));
    }
    (void)problem;
    return evaluations;
  };
}

struct Settings {
  std::vector<Reading> readings = full_study();
  double code_spread = 0.0;     ///< of the code that made the data
  double tolerance = 0.0;       ///< that the diagnosis is told
  int replicates = 0;           ///< behind each standard error; 0: it is known
  bool told_replicates = true;  ///< whether the diagnosis is told how many
  double noise = 1.0;           ///< of the measurements, over the usual
};

/// Errors of one rig share 0.4 of their size.
inline Eigen::MatrixXd measurement_covariance(const std::vector<Reading>& readings, double noise) {
  const auto n = static_cast<Eigen::Index>(readings.size());
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Observable& a = observables().at(readings[static_cast<std::size_t>(i)].observable);
    for (Eigen::Index j = 0; j < n; ++j) {
      const Observable& b = observables().at(readings[static_cast<std::size_t>(j)].observable);
      const double product = noise * noise * a.measured * b.measured;
      covariance(i, j) = a.rig == b.rig ? 0.16 * product : 0.0;
      if (i == j) covariance(i, j) += product;
    }
  }
  return covariance;
}

/// Draws the truth from the middle of the box, measures it, and calibrates: 80 runs over the box,
/// 64 around the best.
inline Problem make_problem(std::uint64_t seed,
                            const Hidden& hidden,
                            const Settings& settings = {}) {
  Problem problem;
  problem.hidden = hidden;
  engine::Random random(seed, engine::Purpose::trial);
  for (double& u : problem.truth) u = random.uniform(0.15, 0.85);
  calibrator::Calibration& c = problem.calibration;
  c.name = "stand-in";
  c.seed = seed;
  for (std::size_t k = 0; k < 5; ++k) c.free.push_back({parameter(k), 0.0, 1.0, {}, {}});
  const std::vector<Reading>& readings = settings.readings;
  const auto n = static_cast<Eigen::Index>(readings.size());
  const Eigen::MatrixXd covariance = measurement_covariance(readings, settings.noise);
  Eigen::VectorXd white(n);
  for (double& w : white) w = random.normal();
  const Eigen::MatrixXd root = covariance.llt().matrixL();
  const Eigen::VectorXd noise = root * white;
  const OtherCode code{settings.code_spread, seed};
  problem.covariance = covariance;
  problem.freedom = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
  for (Eigen::Index j = 0; j < n; ++j) {
    const Reading& reading = readings[static_cast<std::size_t>(j)];
    calibrator::Measurement m;
    m.experiment = {observables().at(reading.observable).rig, {}, reading.condition};
    m.observable = reading.observable;
    m.value = code(problem.truth, hidden, reading) + noise(j);
    m.standard_error = std::sqrt(covariance(j, j));
    if (settings.replicates > 1) {  // what that many repetitions would say it is
      double squares = 0.0;
      for (int r = 1; r < settings.replicates; ++r) {
        const double x = random.normal();
        squares += x * x;
      }
      const double ratio = std::sqrt(squares / (settings.replicates - 1));
      m.standard_error *= ratio;
      problem.covariance.row(j) *= ratio;
      problem.covariance.col(j) *= ratio;
      if (settings.told_replicates) problem.freedom(j) = settings.replicates - 1.0;
    }
    c.measurements.push_back(std::move(m));
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const std::string& a = readings[static_cast<std::size_t>(i)].observable;
      if (a != readings[static_cast<std::size_t>(j)].observable) continue;
      problem.covariance(i, j) +=
          settings.tolerance * settings.tolerance * (i == j ? 1.0 : calibrator::shared_tolerance);
    }
  }
  for (const std::string_view effect : effects) {
    problem.suspects.push_back({.name = std::string(effect),
                                .title = std::string(effect),
                                .levers = {{.key = strength(effect),
                                            .lower = -calibrator::largest_strength,
                                            .upper = calibrator::largest_strength}},
                                .two_sided = effect == "wall"});
  }
  // The calibration: a design over the box, then two around the set that explains most.
  const calibrator::Evaluator ask = evaluator(problem);
  const calibrator::SearchSpace space(c);
  const calibrator::Suite suite(c.measurements);
  std::vector<double> best(5, 0.5);
  double smallest = std::numeric_limits<double>::infinity();
  const std::array<std::pair<std::size_t, double>, 3> rounds{{{80, 0.5}, {40, 0.22}, {24, 0.16}}};
  std::uint64_t run = 0;
  for (std::size_t round = 0; round < rounds.size(); ++round) {
    const std::vector<double> centre = best;
    for (const auto& u : calibrator::latin_hypercube(rounds[round].first, 5, seed, round)) {
      std::vector<double> at(5);
      for (std::size_t k = 0; k < 5; ++k) {
        at[k] = std::clamp(centre[k] + rounds[round].second * (2.0 * u[k] - 1.0), 0.0, 1.0);
      }
      std::vector<engine::Trial> trials;
      suite.append_trials(space.at(at), {}, seed * 1000 + ++run, trials);
      calibrator::HistoryPoint point;
      point.evaluation = static_cast<int>(run);
      point.stage = "search";
      point.parameters = space.at(at);
      point.values = suite.read(ask(trials));
      Eigen::VectorXd gap(n);
      for (Eigen::Index j = 0; j < n; ++j) {
        gap(j) = point.values[static_cast<std::size_t>(j)] -
                 c.measurements[static_cast<std::size_t>(j)].value;
      }
      point.misfit = gap.dot(problem.covariance.llt().solve(gap));
      if (point.misfit < smallest) {
        smallest = point.misfit;
        best = at;
      }
      problem.fit.history.push_back(std::move(point));
    }
  }
  problem.fit.best = space.at(best);
  return problem;
}

/// A reading as a study has it; its value is open.
inline calibrator::Measurement measurement_of(const Reading& reading, double noise) {
  const Observable& observable = observables().at(reading.observable);
  calibrator::Measurement measurement;
  measurement.experiment = {observable.rig, {}, reading.condition};
  measurement.observable = reading.observable;
  measurement.standard_error = std::sqrt(1.16) * noise * observable.measured;
  return measurement;
}

inline calibrator::DiagnosisQuestion question_of(const Problem& problem) {
  const auto count = problem.covariance.rows();
  return {problem.calibration,
          problem.fit,
          problem.suspects,
          problem.covariance,
          Eigen::VectorXd::Ones(count),
          problem.freedom,
          Eigen::VectorXd::Zero(count),
          {}};
}

inline calibrator::Diagnosis diagnose(const Problem& problem) {
  return *calibrator::diagnose(question_of(problem), evaluator(problem));
}

}  // namespace repose::stand_in
