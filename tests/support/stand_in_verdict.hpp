/// What a diagnosis of a stand-in's problem came to, beside its truth.
#pragma once

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>

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
