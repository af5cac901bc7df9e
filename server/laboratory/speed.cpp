#include "server/laboratory/speed.hpp"

#include <ctime>
#include <stdexcept>
#include <variant>

#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"

namespace repose::server {

std::vector<ExperimentCost> laboratory_costs(const engine::ParameterSet& grain,
                                             const std::stop_token& stop) {
  std::vector<ExperimentCost> costs;
  for (const engine::ExperimentInfo& info : engine::experiment_catalogue()) {
    ExperimentCost cost{.experiment = std::string(info.name)};
    for (const auto fidelity : {engine::Fidelity::draft, engine::Fidelity::standard}) {
      const auto place = static_cast<std::size_t>(fidelity);
      const std::clock_t start = std::clock();
      const engine::Evaluation evaluation =
          engine::evaluate({grain, {cost.experiment, fidelity, {}}, 1}, {.stop = stop});
      cost.seconds.at(place) = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      cost.grain_steps.at(place) = static_cast<double>(evaluation.effort.grain_steps);
      if (const auto* failure = std::get_if<engine::Failure>(&evaluation.outcome)) {
        throw std::runtime_error(cost.experiment + ": " + failure->message);
      }
    }
    costs.push_back(std::move(cost));
  }
  return costs;
}

ExperimentCost sum(const std::vector<ExperimentCost>& costs) {
  ExperimentCost all{.experiment = "all"};
  for (const ExperimentCost& cost : costs) {
    for (std::size_t k = 0; k < all.seconds.size(); ++k) {
      all.seconds.at(k) += cost.seconds.at(k);
      all.grain_steps.at(k) += cost.grain_steps.at(k);
    }
  }
  return all;
}

}  // namespace repose::server
