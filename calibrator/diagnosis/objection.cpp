#include "calibrator/diagnosis/objection.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "calibrator/diagnosis/tolerance.hpp"
#include "calibrator/misfit.hpp"
#include "calibrator/phrase.hpp"
#include "engine/catalogue.hpp"

namespace repose::calibrator {
namespace {

/// Experiments that the study does not use.
std::string unused_experiments(const Calibration& calibration) {
  std::string names;
  for (const engine::ExperimentInfo& info : engine::experiment_catalogue()) {
    const bool used = std::ranges::any_of(calibration.measurements, [&](const Measurement& m) {
      return m.experiment.name == info.name;
    });
    if (!used) names += (names.empty() ? "" : ", ") + std::string(info.name);
  }
  return names;
}

void few_measurements(const Calibration& calibration,
                      const Fit& fit,
                      std::vector<std::string>& found) {
  const auto fitted = static_cast<std::size_t>(
      std::ranges::count(calibration.measurements, Role::fit, &Measurement::role));
  const auto learnt =
      static_cast<std::size_t>(std::ranges::count_if(fit.directions, &Direction::learnt));
  if (fitted > learnt) return;
  const std::string others = unused_experiments(calibration);
  found.push_back(
      "it cannot be tested: " + counted(fitted, "measurement") + " determined " +
      counted(learnt, "direction") +
      " of the free parameters, so that nothing is left to tell whether the model is right; add " +
      (others.empty() ? "measurements under other conditions"
                      : "a measurement of another kind (" + others + ")") +
      ", or fix parameters that are known");
}

void contradictions(const Calibration& calibration, std::vector<std::string>& found) {
  constexpr double apart = 5.0;  // standard errors
  const auto& all = calibration.measurements;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!is_same_quantity(all[i], all[j])) continue;
      const double error = std::hypot(standard_uncertainty(all[i]), standard_uncertainty(all[j]));
      const double gap = std::abs(all[i].value - all[j].value);
      if (!(gap > apart * error)) continue;
      found.push_back("measurements " + std::to_string(j + 1) + " and " + std::to_string(i + 1) +
                      " contradict each other: " + observable_name(all[i]) + " is " +
                      quantity(all[j].value, all[j].unit, 4) + " and " +
                      quantity(all[i].value, all[i].unit, 4) + " under the same conditions, " +
                      number(gap / error, 4) + " standard errors apart; at most " +
                      number(apart, 4) + " can be chance");
    }
  }
}

void missing_errors(const Calibration& calibration, std::vector<std::string>& found) {
  for (std::size_t j = 0; j < calibration.measurements.size(); ++j) {
    const Measurement& measurement = calibration.measurements[j];
    if (standard_uncertainty(measurement) > 0.0) continue;
    found.push_back("measurement " + std::to_string(j + 1) + " (" + observable_name(measurement) +
                    ") has no standard error: without one no difference means anything");
  }
}

}  // namespace

std::vector<std::string> objections(const Calibration& calibration, const Fit& fit) {
  std::vector<std::string> found;
  few_measurements(calibration, fit, found);
  contradictions(calibration, found);
  missing_errors(calibration, found);
  return found;
}

}  // namespace repose::calibrator
