#include "server/studies/study_plan.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/catalogue.hpp"
#include "engine/size_population.hpp"
#include "engine/unit.hpp"
#include "server/cli/assignment.hpp"
#include "server/json/calibration_json.hpp"
#include "server/report/number_text.hpp"

namespace repose::server {

namespace {

void assign(engine::ParameterSet& parameters, const std::string& text) {
  const auto assignment = parse_parameter(text);
  if (!assignment) throw std::invalid_argument(assignment.error());
  parameters.set(assignment->key, assignment->value);
}

/// The level of a factor in a run's code, counted from 0. The letter and the line after the first
/// digit are no digits of factors: "1s_16233".
std::size_t level_of(const PublishedStudy& study, const StudyFactor& factor, std::string_view run) {
  const auto place = static_cast<std::size_t>(&factor - study.factors.data());
  std::size_t digit = 0;
  for (const char letter : run) {
    if (letter < '0' || letter > '9') continue;
    if (digit++ != place) continue;
    const auto level = static_cast<std::size_t>(letter - '0');
    if (level < 1 || level > factor.levels.size()) break;
    return level - 1;
  }
  throw std::invalid_argument("run " + std::string(run) + " has no level of " + factor.factor);
}

}  // namespace

const StudyRun& PublishedStudy::run(std::string_view wanted) const {
  const auto found = std::ranges::find(runs, wanted, &StudyRun::run);
  if (found == runs.end()) throw std::out_of_range("no run " + std::string(wanted));
  return *found;
}

engine::Fidelity fidelity_of(StudySize size) {
  return size == StudySize::quick ? engine::Fidelity::draft : engine::Fidelity::paper;
}

int replicates_of(const StudyExperiment& experiment, StudySize size) {
  return size == StudySize::quick ? experiment.quick_replicates : experiment.replicates;
}

engine::ParameterSet run_parameters(const PublishedStudy& study, std::string_view run) {
  engine::ParameterSet parameters;
  for (const std::string& text : study.common) assign(parameters, text);
  for (const StudyFactor& factor : study.factors) {
    const std::vector<double>& level = factor.levels[level_of(study, factor, run)];
    for (std::size_t i = 0; i < factor.parameters.size(); ++i) {
      assign(parameters,
             factor.parameters[i] + "=" + number_text(level.at(i), 6) +
                 (factor.unit == "1" ? "" : " " + factor.unit));
    }
  }
  return parameters;
}

std::string level_text(const PublishedStudy& study,
                       const StudyFactor& factor,
                       std::string_view run) {
  const std::vector<double>& level = factor.levels[level_of(study, factor, run)];
  std::string text = number_text(level.front());
  if (level.back() != level.front()) text += " / " + number_text(level.back());
  return text + (factor.unit == "1" ? "" : " " + factor.unit);
}

std::string difference_text(const PublishedStudy& study, std::string_view run) {
  std::string text;
  for (const StudyFactor& factor : study.factors) {
    if (level_of(study, factor, run) == level_of(study, factor, study.base)) continue;
    text += (text.empty() ? "" : ", ") + factor.factor + " " + level_text(study, factor, run);
  }
  return text.empty() ? "base" : text;
}

std::vector<engine::Trial> replicate_trials(const engine::ParameterSet& parameters,
                                            const engine::Experiment& experiment,
                                            int replicates,
                                            std::uint64_t first_seed) {
  std::vector<engine::Trial> trials;
  trials.reserve(static_cast<std::size_t>(replicates));
  for (int i = 0; i < replicates; ++i) {
    trials.push_back({parameters, experiment, first_seed + static_cast<std::uint64_t>(i)});
  }
  return trials;
}

double expected_cost(const engine::ParameterSet& parameters) {
  const auto of_grain = [&](std::string_view field, double otherwise) {
    return parameters.get_or(engine::make_key(field, {engine::MaterialId::grain}), otherwise);
  };
  const double smallest = std::cbrt(engine::size_population(parameters).smallest);
  return of_grain("grain_shape.members", 1.0) * std::sqrt(of_grain("material.shear_modulus", 1.0)) /
         smallest;
}

engine::ParameterSet variant_parameters(const PublishedStudy& study, const StudyVariant& variant) {
  engine::ParameterSet parameters = run_parameters(study, study.base);
  for (const std::string& text : variant.set) assign(parameters, text);
  return parameters;
}

engine::Experiment variant_experiment(const StudyVariant& variant,
                                      std::string_view experiment,
                                      StudySize size) {
  const engine::ExperimentInfo* info = engine::find_experiment(experiment);
  if (info == nullptr) throw std::invalid_argument("no experiment " + std::string(experiment));
  engine::Experiment result{std::string(experiment), fidelity_of(size), {}};
  for (const std::string& text : variant.settings) {
    const auto assignment = parse_setting(*info, text);
    if (!assignment) throw std::invalid_argument(assignment.error());
    result.settings[assignment->name] = assignment->value;
  }
  return result;
}

calibrator::Calibration study_search(const PublishedStudy& study, StudySize size) {
  const auto parsed = parse_calibration(study.search);
  if (!parsed) throw std::invalid_argument(parsed.error().front().message);
  calibrator::Calibration search = *parsed;
  search.budget.fidelity = search.budget.confirm_fidelity = fidelity_of(size);
  for (calibrator::Measurement& measurement : search.measurements) {
    measurement.experiment.fidelity = fidelity_of(size);
  }
  if (size == StudySize::quick) search.budget.evaluations = study.quick_search_evaluations;
  return search;
}

}  // namespace repose::server
