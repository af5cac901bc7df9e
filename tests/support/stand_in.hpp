/// A stand-in for a suite of experiments, to measure how often a diagnosis is right: smooth made-up
/// responses of five parameters, thirteen effects and some departures outside any catalogue. No
/// physics: its rankings and error rates count, not its numbers.
///
/// Observables are logarithms, so that noise is relative. The settings of an experiment are its
/// condition: moisture M (%), height h (m), Froude number Fr, stress sg (kPa).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "calibrator/calibration.hpp"
#include "calibrator/design.hpp"
#include "calibrator/diagnosis/diagnose.hpp"
#include "calibrator/diagnosis/screen.hpp"
#include "calibrator/evaluator.hpp"
#include "calibrator/fit.hpp"
#include "calibrator/misfit.hpp"
#include "calibrator/search_space.hpp"
#include "engine/random.hpp"

namespace repose::stand_in {

inline constexpr std::array<std::string_view, 13> effects{"shape",
                                                          "jkr",
                                                          "capillary",
                                                          "visco_e",
                                                          "plastic_e",
                                                          "hysteresis",
                                                          "drag",
                                                          "wall",
                                                          "twist",
                                                          "weaken",
                                                          "moist_G",
                                                          "moist_mu",
                                                          "tap"};

inline constexpr std::array<std::string_view, 5> outside{
    "swelling", "breakage", "tilt_bias", "static_charge", "segregation"};

/// Strengths by name; absent: none.
using Hidden = std::map<std::string, double, std::less<>>;

struct Observable {
  std::string rig;
  std::string kind;
  double measured;   ///< standard error of its measurement, relative
  double simulated;  ///< scatter of a run, relative
};

inline const std::map<std::string, Observable>& observables() {
  static const std::map<std::string, Observable> all{
      {"density", {"kettle", "dens", 0.008, 0.004}},
      {"static_angle", {"tiltbox", "stat", 0.025, 0.030}},
      {"heap_angle", {"heap", "heap", 0.030, 0.030}},
      {"rebound", {"drop", "reb", 0.020, 0.004}},
      {"rate", {"hopper", "rate", 0.015, 0.012}},
      {"drawdown_angle", {"hopper", "draw", 0.030, 0.030}},
      {"drum_angle", {"drum", "drum", 0.020, 0.015}},
      {"stiffness", {"oedo", "stif", 0.030, 0.020}},
      {"residual", {"oedo", "resd", 0.030, 0.030}},
      {"wall_angle", {"plane", "wang", 0.020, 0.006}},
  };
  return all;
}

/// The logarithm of one observable.
inline double response(const std::array<double, 5>& u,
                       const Hidden& hidden,
                       const std::string& observable,
                       const std::map<std::string, double>& condition) {
  const auto phi = [&](std::string_view name) {
    const auto found = hidden.find(name);
    return found == hidden.end() ? 0.0 : found->second;
  };
  const auto at = [&](const char* name) {
    const auto found = condition.find(name);
    return found == condition.end() ? 0.0 : found->second;
  };
  const auto th = [](double x) { return std::tanh(x); };
  const double e = 0.35 + 0.55 * u[0], mu0 = 0.15 + 0.60 * u[1], mur = 0.02 + 0.28 * u[2];
  const double s = 0.05 + 0.30 * u[3], lgG = 6.0 + 2.5 * u[4];
  const double a = phi("shape"), hy = phi("hysteresis"), dr = phi("drag"), tp = phi("tap");
  const double tw = phi("twist"), dw = phi("wall"), wk = phi("weaken"), ch = phi("static_charge");
  const double sg = phi("segregation"), br = phi("breakage");
  const double moist = at("M"), m = (moist - 10.0) / 8.0;
  const double mu = mu0 * (1 + 0.6 * phi("moist_mu") * m);
  const double G = std::pow(10.0, lgG - 0.55 * phi("moist_G") * m);
  const double en = e - 0.12 * phi("moist_G") * m;
  const double muk = mu * (1 - 0.45 * wk), muw = mu * (1 + 0.5 * dw);
  const double t = std::max((moist - 11.0) / 7.0, 0.0);
  const double Bo = 2.5 * phi("jkr") + 3.0 * phi("capillary") * std::pow(t, 1.3) / (1 + 0.4 * t);
  const double bump = (a / 0.45) * std::exp(1 - a / 0.45);
  const double pf = 0.640 - 0.060 * th(mu / 0.35) - 0.040 * th(mur / 0.12) + 0.28 * s * s +
                    0.015 * (en - 0.6) - 0.085 * Bo / (Bo + 2.5) +
                    0.040 * bump * (1 - 0.5 * th(mu / 0.5)) - 0.015 * a * a - 0.004 * dw -
                    0.004 * dr - 0.006 * tw * th(mu / .4) + 0.0015 * std::pow(1e7 / G, 2.0 / 3.0) -
                    0.008 * ch;
  const double pfp = pf + 0.055 * tp * (0.66 - pf) / 0.08;
  const double roll = 0.35 + 0.65 * th(mu / 0.4);
  const std::string& kind = observables().at(observable).kind;
  double value = 0.0;
  if (kind == "dens") {
    value = pfp * std::exp(-0.06 * phi("swelling") * m);
  } else if (kind == "stat") {
    value = 0.24 + 0.30 * th(mu / 0.45) + 0.42 * th(mur / 0.15) * roll + 0.10 * th(2.2 * a) +
            0.15 * Bo / (1 + 0.30 * Bo) + 0.045 * tw * th(mu / 0.4) - 0.06 * (s - 0.2) +
            0.015 * dw + 0.02 * ch;
    value *= 1 + 0.10 * phi("tilt_bias");
  } else if (kind == "heap") {
    value = 0.21 + 0.28 * th(0.5 * (mu + muk) / 0.45) +
            0.45 * th(mur / 0.13) * (0.35 + 0.65 * th(0.5 * (mu + muk) / .4)) + 0.09 * th(2.0 * a) +
            0.10 * Bo / (1 + 0.30 * Bo) + 0.050 * tw * th(mu / 0.4) - 0.14 * (en - 0.5) -
            0.02 * dr + 0.06 * sg;
  } else if (kind == "reb") {
    const double h = at("h");
    const double v = std::sqrt(2 * 9.81 * h) * (1 - 0.06 * dr * std::min(h, 2.0) / 0.4);
    value = en - 0.30 * phi("visco_e") * (std::pow(v, 0.2) - 1.0);
    value *= std::pow(std::sqrt(v * v + 0.36) / 1.2, -0.25 * phi("plastic_e"));
    value *= (1 - 0.10 * a) * (1 - 0.20 * hy) * (1 - 0.05 * dr * std::min(h, 2.0) / 0.4);
    value = std::max(value - 0.012 * Bo / (v * v) * 0.5, 0.03);
  } else if (kind == "rate") {
    value = 0.58 * (pf / 0.6) * (1 - 0.25 * th(muk / 0.4)) * (1 - 0.10 * th(mur / 0.15)) *
            (1 - 0.08 * a) * (1 - 0.13 * Bo / (1 + Bo)) * (1 - 0.06 * dr) * (1 + 0.05 * (en - .6)) *
            (1 - 0.03 * dw) * (1 + 0.10 * (s - .2)) * (1 - 0.07 * ch) * (1 - 0.06 * sg);
  } else if (kind == "draw") {
    value = 0.30 + 0.32 * th(mu / 0.45) + 0.40 * th(mur / 0.15) * roll + 0.12 * th(2.2 * a) +
            0.22 * Bo / (1 + 0.25 * Bo) + 0.040 * tw * th(mu / 0.4) + 0.02 * dw - 0.08 * sg;
  } else if (kind == "drum") {
    const double q = std::sqrt(at("Fr"));
    const double mf = mu + (muk - mu) * th(0.3 + 6 * q);
    value = 0.23 + 0.30 * th(mf / 0.45) + 0.42 * th(mur / 0.15) * (0.35 + 0.65 * th(mf / .4)) +
            0.55 * q * (0.6 + 0.8 * th(mf / 0.5)) + 0.09 * th(2.0 * a) * (1 + 0.5 * q) +
            0.13 * Bo / (1 + 0.30 * Bo) * (1 - 0.8 * q) + 0.040 * tw * th(mu / 0.4) -
            0.05 * (en - 0.5) * (1 + 5 * q) + 0.02 * dw - 0.07 * dr * q;
  } else if (kind == "stif") {
    const double st = at("sg") / 100.0;
    value = std::pow(G / 1e7, 2.0 / 3.0) * std::cbrt(st) * std::pow(pfp / 0.6, 3) *
            (1 + 0.10 * th(mu / 0.4)) * (1 - 0.30 * hy * std::pow(st, 0.15)) * (1 + 0.10 * a) *
            (1 + 0.10 * tp) * (1 - 0.20 * br * st / (1 + st));
  } else if (kind == "resd") {
    const double st = at("sg") / 100.0;
    value = 0.30 + 0.30 * hy * std::pow(st, 0.1) + 0.04 * Bo / (1 + Bo) - 0.08 * tp +
            0.10 * th(mu / 0.4) - 0.8 * (pfp - 0.58) + 0.22 * br * st / (1 + st);
  } else {  // the plane
    value = muw * (1 - 0.45 * wk * 0.15) + 0.015 * Bo + 0.05 * ch * (1 - m);
  }
  return std::log(std::max(value, 1e-4));
}

struct Reading {
  std::string observable;
  std::map<std::string, double> condition;
};

/// The twenty-six readings of the full study.
inline std::vector<Reading> full_study() {
  std::vector<Reading> all;
  for (const double m : {10.0, 14.0, 18.0}) all.push_back({"density", {{"M", m}}});
  for (const double m : {10.0, 14.0, 18.0}) all.push_back({"static_angle", {{"M", m}}});
  for (const double m : {10.0, 18.0}) all.push_back({"heap_angle", {{"M", m}}});
  for (const double h : {0.05, 0.15, 0.40}) all.push_back({"rebound", {{"M", 10.0}, {"h", h}}});
  all.push_back({"rebound", {{"M", 18.0}, {"h", 0.15}}});
  for (const double m : {10.0, 18.0}) all.push_back({"rate", {{"M", m}}});
  for (const double m : {10.0, 18.0}) all.push_back({"drawdown_angle", {{"M", m}}});
  for (const double fr : {0.002, 0.02, 0.10}) {
    all.push_back({"drum_angle", {{"M", 10.0}, {"Fr", fr}}});
  }
  all.push_back({"drum_angle", {{"M", 18.0}, {"Fr", 0.02}}});
  for (const double sg : {20.0, 100.0}) all.push_back({"stiffness", {{"M", 10.0}, {"sg", sg}}});
  all.push_back({"stiffness", {{"M", 18.0}, {"sg", 100.0}}});
  all.push_back({"residual", {{"M", 10.0}, {"sg", 100.0}}});
  for (const double m : {10.0, 18.0}) all.push_back({"wall_angle", {{"M", m}}});
  return all;
}

/// The readings at one moisture.
inline std::vector<Reading> at_moisture(double moisture) {
  std::vector<Reading> all = full_study();
  std::erase_if(all, [](const Reading& reading) { return reading.condition.at("M") != 10.0; });
  for (Reading& reading : all) reading.condition["M"] = moisture;
  return all;
}

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
      problem.covariance(i, j) += settings.tolerance * settings.tolerance * (i == j ? 1.0 : 0.95);
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

inline calibrator::Diagnosis diagnose(const Problem& problem) {
  const calibrator::DiagnosisQuestion question{problem.calibration,
                                               problem.fit,
                                               problem.suspects,
                                               problem.covariance,
                                               Eigen::VectorXd::Ones(problem.covariance.rows()),
                                               problem.freedom};
  return *calibrator::diagnose(question, evaluator(problem));
}

/// One effect, or effects that no study of this kind can tell apart.
inline std::string_view class_of(std::string_view effect) {
  return effect == "visco_e" || effect == "plastic_e" ? "e(v)" : effect;
}

}  // namespace repose::stand_in
