#include "engine/evaluate.hpp"

#include "engine/catalogue.hpp"

namespace repose::engine {

std::string_view version() { return REPOSE_ENGINE_VERSION; }

Evaluation evaluate(const Trial& trial, const Run& run) {
  const ExperimentInfo* info = find_experiment(trial.experiment.name);
  if (info == nullptr) {
    return {trial,
            Failure{FailureKind::bad_input, "there is no experiment " + trial.experiment.name, 0.0},
            {}};
  }
  return info->run(trial, run);
}

}  // namespace repose::engine
