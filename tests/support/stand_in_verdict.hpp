/// What a diagnosis of a stand-in's problem came to, beside its truth.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <string_view>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "calibrator/diagnosis/diagnosis.hpp"
#include "tests/support/stand_in.hpp"

namespace repose::stand_in {

inline bool alarmed(const calibrator::Diagnosis& diagnosis) {
  return diagnosis.verdict != calibrator::DiagnosisVerdict::adequate &&
         diagnosis.verdict != calibrator::DiagnosisVerdict::not_testable;
}

inline bool names_an_effect(const calibrator::Diagnosis& diagnosis) {
  return diagnosis.verdict == calibrator::DiagnosisVerdict::named ||
         diagnosis.verdict == calibrator::DiagnosisVerdict::family ||
         diagnosis.verdict == calibrator::DiagnosisVerdict::pair;
}

/// Class of the first effect of a refit.
inline std::string class_of_refit(const calibrator::Diagnosis& diagnosis, std::size_t index) {
  const std::size_t effect = diagnosis.refits[index].effects.front();
  return std::string(class_of(diagnosis.effects[effect].suspect.name));
}

/// Class of the effect in front; empty where nothing was refitted.
inline std::string front_class(const calibrator::Diagnosis& diagnosis) {
  return diagnosis.refits.empty() ? "" : class_of_refit(diagnosis, 0);
}

/// Classes that the data cannot tell apart, families counted.
inline std::set<std::string> open_classes(const calibrator::Diagnosis& diagnosis) {
  std::set<std::string> classes;
  for (const std::size_t index : diagnosis.plausible)
    classes.insert(class_of_refit(diagnosis, index));
  for (const auto& family : diagnosis.families) {
    std::set<std::string> own;
    for (const std::size_t effect : family) {
      own.insert(std::string(class_of(diagnosis.effects[effect].suspect.name)));
    }
    const bool touched =
        std::ranges::any_of(own, [&](const std::string& name) { return classes.contains(name); });
    if (touched) classes.insert(own.begin(), own.end());
  }
  return classes;
}

/// How much evidence of what is hidden the readings could hold, lambda: its squared trace at the
/// truth, in the readings' errors, less what the free parameters imitate.
inline double noncentrality(const Problem& problem) {
  const auto& measurements = problem.calibration.measurements;
  const auto n = static_cast<Eigen::Index>(measurements.size());
  const auto answers = [&](const std::array<double, 5>& u, const Hidden& hidden) {
    Eigen::VectorXd result(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto& own = measurements[static_cast<std::size_t>(j)];
      result(j) = response(u, hidden, own.observable, own.experiment.settings);
    }
    return result;
  };
  constexpr double prior_deviation = 0.6, step = 1e-3;
  const Eigen::MatrixXd root = problem.covariance.llt().matrixL();
  const auto whiten = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return root.triangularView<Eigen::Lower>().solve(x);
  };
  Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(n + 5, 5);
  for (Eigen::Index k = 0; k < 5; ++k) {
    auto right = problem.truth, left = problem.truth;
    right[static_cast<std::size_t>(k)] += step;
    left[static_cast<std::size_t>(k)] -= step;
    tangent.col(k).head(n) = whiten((answers(right, {}) - answers(left, {})) / (2.0 * step));
    tangent(n + k, k) = 1.0 / prior_deviation;
  }
  Eigen::VectorXd trace = Eigen::VectorXd::Zero(n + 5);
  trace.head(n) = whiten(answers(problem.truth, problem.hidden) - answers(problem.truth, {}));
  return (trace - tangent * tangent.colPivHouseholderQr().solve(trace)).squaredNorm();
}

/// The effect of the largest score; what the screen alone would say.
inline std::string_view screened_first(const calibrator::Diagnosis& diagnosis) {
  return std::ranges::max_element(
             diagnosis.effects, {}, [](const auto& finding) { return finding.score; })
      ->suspect.name;
}

/// The effect whose whole trace, what the parameters can imitate included, is nearest to the
/// residuals: what no projection would say.
inline std::string nearest_raw(const Problem& problem, const calibrator::Diagnosis& diagnosis) {
  std::string nearest;
  double largest = 0.0;
  for (const auto& finding : diagnosis.effects) {
    double along = 0.0, size = 0.0;
    for (std::size_t j = 0; j < finding.change.size(); ++j) {
      const auto i = static_cast<Eigen::Index>(j);
      const double deviation = std::sqrt(problem.covariance(i, i));
      const double gap =
          (problem.calibration.measurements[j].value - diagnosis.predicted[j]) / deviation;
      const double change = finding.change[j] / deviation;
      along += gap * change;
      size += change * change;
    }
    const double cosine = (finding.suspect.two_sided ? std::abs(along) : along) / std::sqrt(size);
    if (!(cosine > largest)) continue;
    largest = cosine;
    nearest = finding.suspect.name;
  }
  return nearest;
}

}  // namespace repose::stand_in
