#include "server/json/replicates_json.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "engine/catalogue.hpp"
#include "server/json/text.hpp"
#include "server/laboratory/draft_bias.hpp"
#include "server/report/number_text.hpp"

namespace repose::server {

namespace {

Json failure_json(const engine::Failure& failure) {
  return {{"kind", engine::failure_kind_names.at(static_cast<std::size_t>(failure.kind))},
          {"message", failure.message},
          {"simulated_seconds", failure.simulated_seconds}};
}

Json effort_json(const engine::Effort& effort) {
  return {{"grains", effort.grains},
          {"inserted", effort.inserted},
          {"requested", effort.requested},
          {"steps", effort.steps},
          {"grain_steps", effort.grain_steps},
          {"time_step", effort.time_step},
          {"simulated_seconds", effort.simulated_seconds},
          {"largest_overlap", effort.largest_overlap},
          {"overlap_at_rest", effort.overlap_at_rest}};
}

Json run_json(const engine::Evaluation& evaluation, double wall_seconds) {
  Json run{{"seed", evaluation.trial.seed}};
  if (const auto* failure = std::get_if<engine::Failure>(&evaluation.outcome)) {
    run["failure"] = failure_json(*failure);
  } else {
    Json values = Json::object();
    for (const auto& seen : std::get<std::vector<engine::Observation>>(evaluation.outcome)) {
      values[seen.name] = number_or_null(seen.value);
    }
    run["observations_si"] = std::move(values);
  }
  run.update(effort_json(evaluation.effort));
  run["wall_seconds"] = wall_seconds;
  return run;
}

/// By observable: how draft readings lie to standard ones, where that was measured.
Json draft_json(const engine::ExperimentInfo& info) {
  Json document = Json::object();
  for (const engine::ObservableInfo& seen : info.observables) {
    const DraftBias draft = draft_bias(info, seen);
    if (draft.sets == 0) continue;
    document[std::string(seen.name)] = {{"mean", draft.mean / seen.unit.factor},
                                        {"standard_deviation", draft.deviation / seen.unit.factor},
                                        {"sets", draft.sets},
                                        {"unit", seen.unit.symbol}};
  }
  return document;
}

}  // namespace

const engine::Evaluation* Replicates::failed() const {
  const auto is_failure = [](const engine::Evaluation& evaluation) {
    return std::holds_alternative<engine::Failure>(evaluation.outcome);
  };
  const auto found = std::ranges::find_if(evaluations, is_failure);
  return found == evaluations.end() ? nullptr : &*found;
}

engine::Effort Replicates::effort() const {
  engine::Effort sum;
  if (evaluations.empty()) return sum;
  sum = evaluations.front().effort;
  for (std::size_t i = 1; i < evaluations.size(); ++i) {
    const engine::Effort& effort = evaluations[i].effort;
    sum.inserted += effort.inserted;
    sum.requested += effort.requested;
    sum.steps += effort.steps;
    sum.grain_steps += effort.grain_steps;
    sum.rebuilds += effort.rebuilds;
    sum.simulated_seconds += effort.simulated_seconds;
    sum.largest_overlap = std::max(sum.largest_overlap, effort.largest_overlap);
    sum.overlap_at_rest = std::max(sum.overlap_at_rest, effort.overlap_at_rest);
  }
  return sum;
}

std::vector<std::string> warnings(const Replicates& replicates) {
  constexpr double hard = 0.01;  // of the radius: contacts of real grains stay below it
  const double overlap = replicates.effort().overlap_at_rest;
  if (!(overlap > hard)) return {};
  return {"at rest grains overlap by up to " + number_text(100.0 * overlap, 2) +
          " % of their radius; beyond 1 % a bed is denser and its contacts are wider than those of "
          "hard grains: a larger shear_modulus shows how much that matters"};
}

double Replicates::particle_steps_per_second() const {
  return elapsed > 0.0 ? static_cast<double>(effort().grain_steps) / elapsed : 0.0;
}

std::string print_replicates(const Replicates& replicates, std::string_view engine_version) {
  const engine::Experiment& experiment = replicates.trial.experiment;
  Json document{
      {"experiment", experiment.name},
      {"fidelity", engine::fidelity_names.at(static_cast<std::size_t>(experiment.fidelity))}};
  if (const engine::Evaluation* failed = replicates.failed()) {
    document["failure"] = failure_json(std::get<engine::Failure>(failed->outcome));
    document["failure"]["seed"] = failed->trial.seed;
  } else {
    document["observations"] = Json::array();
    for (const MeanObservation& seen : replicates.observations) {
      Json& entry = document["observations"].emplace_back(
          Json{{"name", seen.name},
               {"value", number_or_null(seen.value / seen.unit.factor)},
               {"standard_error", number_or_null(seen.standard_error / seen.unit.factor)},
               {"unit", seen.unit.symbol}});
      if (!seen.unread.empty()) entry["unread"] = seen.unread;
    }
    const engine::ExperimentInfo& info = *engine::find_experiment(experiment.name);
    if (draft_is_in_force(info, experiment)) document["draft_less_standard"] = draft_json(info);
  }
  document.update(effort_json(replicates.effort()));
  document["warnings"] = warnings(replicates);
  document["wall_seconds"] = replicates.elapsed;
  document["particle_steps_per_second"] = number_or_null(replicates.particle_steps_per_second());
  document["seed"] = replicates.trial.seed;
  document["replicates"] = replicates.evaluations.size();
  document["parameters"] = Json::object();
  for (const auto& [key, value] : replicates.trial.parameters) {
    document["parameters"][engine::to_string(key)] = value;
  }
  document["settings"] = experiment.settings;
  document["engine_version"] = engine_version;
  document["runs"] = Json::array();
  for (std::size_t i = 0; i < replicates.evaluations.size(); ++i) {
    document["runs"].push_back(run_json(replicates.evaluations[i], replicates.wall_seconds.at(i)));
  }
  return to_text(document, 2);
}

std::string print_error(const std::string& message, const Problems& problems) {
  Json list = Json::array();
  for (const Problem& problem : problems) {
    list.push_back({{"pointer", problem.pointer},
                    {"message", problem.message},
                    {"found", problem.found},
                    {"allowed", problem.allowed}});
  }
  return to_text(Json{{"error", {{"message", message}, {"problems", std::move(list)}}}}, 2);
}

}  // namespace repose::server
