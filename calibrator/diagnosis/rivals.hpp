/// Rivals: the explanations that a concluded diagnosis leaves open, as parameter sets that they
/// allow, so that each can be asked what it expects of a measurement not made yet.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "calibrator/diagnosis/deciding_measurement.hpp"
#include "calibrator/diagnosis/models.hpp"
#include "calibrator/diagnosis/question.hpp"

namespace repose::calibrator {

/// What a concluded diagnosis leaves open, with weights of sum 1.
struct OpenExplanations {
  std::vector<std::pair<std::size_t, double>> refits;    ///< by index
  double calibrated = 0.0;                               ///< the model as it is
  std::vector<std::pair<std::size_t, double>> imitated;  ///< effects that the data cannot see
};

/// The plausible refits, and the calibrated model where an excuse does as well, else the runner-up;
/// where nothing is missing, effects that could not be tested.
OpenExplanations open_explanations(const Diagnosis& diagnosis);

/// The model's optimum and some draws about it; `stream` tells rivals apart.
Rival rival_of(const DiagnosisQuestion& question,
               const SuiteRuns& runs,
               const Model& model,
               double weight,
               std::uint64_t stream);

/// A strong effect that these data cannot see, since the free parameters hide it: by one step from
/// the calibrated model. `change`: of all measurements per unit of its strength.
Model imitated(const Models& models,
               const Model& base,
               std::size_t suspect,
               const std::vector<double>& change);

}  // namespace repose::calibrator
