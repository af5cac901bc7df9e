#include "engine/evaluate.hpp"

#include "engine/catalogue.hpp"

namespace repose::engine {

std::string_view version() { return REPOSE_ENGINE_VERSION; }

std::string refusal(const Trial& trial) {
  const ExperimentInfo* info = find_experiment(trial.experiment.name);
  return info == nullptr ? "there is no experiment " + trial.experiment.name : info->refusal(trial);
}

Evaluation evaluate(const Trial& trial, const Run& run) {
  const ExperimentInfo* info = find_experiment(trial.experiment.name);
  if (info == nullptr) {
    return {trial, Failure{FailureKind::bad_input, refusal(trial), 0.0}, {}};
  }
  return info->run(trial, run);
}

}  // namespace repose::engine
