#include "calibrator/diagnosis/suite_runs.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "engine/random.hpp"

namespace repose::calibrator {

SuiteRuns::SuiteRuns(const Calibration& calibration,
                     std::span<const Suspect> suspects,
                     const Evaluator& evaluator,
                     const Fit& fit)
    : calibration_(calibration),
      suspects_(suspects),
      evaluator_(evaluator),
      space_(calibration),
      suite_(calibration.measurements) {
  const bool two_levels = calibration.budget.fidelity != calibration.budget.confirm_fidelity;
  for (const HistoryPoint& point : fit.history) {
    // Runs of another fidelity are another quantity.
    if (two_levels && (point.stage == "confirm" || point.stage == "pair")) continue;
    runs_.push_back({space_.coordinates(point.parameters), {}, point.values});
  }
}

std::uint64_t SuiteRuns::next_seed() {
  // A function of the question alone, so that a replay asks the same.
  return engine::Random(
             calibration_.seed, engine::Purpose::diagnosis, static_cast<std::uint64_t>(spent_++))
             .bits() >>
         11U;
}

std::vector<std::vector<double>> SuiteRuns::run_pairs(const UnitPoint& at,
                                                      engine::Fidelity other,
                                                      int count) {
  std::vector<engine::Trial> trials;
  const engine::ParameterSet parameters = space_.at(at);
  for (int pair = 0; pair < count; ++pair) {
    const std::uint64_t seed = next_seed();
    suite_.append_trials(parameters, calibration_.budget.fidelity, seed, trials);
    suite_.append_trials(parameters, other, seed, trials);
    ++spent_;
  }
  const std::vector<engine::Evaluation> evaluations = evaluator_(trials);
  std::span rest(evaluations);
  std::vector<std::vector<double>> differences;
  for (int pair = 0; pair < count; ++pair) {
    runs_.push_back({at, {}, suite_.read(rest.first(suite_.size()))});
    differences.push_back(suite_.read(rest.subspan(suite_.size(), suite_.size())));
    for (std::size_t j = 0; j < differences.back().size(); ++j) {
      differences.back()[j] -= runs_.back().values[j];
    }
    rest = rest.subspan(2 * suite_.size());
  }
  return differences;
}

void SuiteRuns::run(std::span<const Point> points) {
  std::vector<engine::Trial> trials;
  std::vector<SuiteRun> asked;
  for (const Point& point : points) {
    SuiteRun run{point.at, {}, {}};
    engine::ParameterSet parameters = space_.at(point.at);
    for (const auto& [suspect, strength] : point.strengths) {
      const double snapped = suspects_[suspect].snapped(strength);
      suspects_[suspect].apply(parameters, snapped);
      run.strengths[suspect] = snapped;
    }
    suite_.append_trials(parameters, calibration_.budget.fidelity, next_seed(), trials);
    asked.push_back(std::move(run));
  }
  const std::vector<engine::Evaluation> evaluations = evaluator_(trials);
  assert(evaluations.size() == trials.size());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    asked[i].values = suite_.read(std::span(evaluations).subspan(i * suite_.size(), suite_.size()));
    runs_.push_back(std::move(asked[i]));
  }
}

SuiteRuns::Table SuiteRuns::table(std::span<const std::size_t> on) const {
  std::vector<const SuiteRun*> used;
  for (const SuiteRun& run : runs_) {
    const bool within = std::ranges::all_of(run.strengths, [&](const auto& entry) {
      return entry.second == 0.0 || std::ranges::find(on, entry.first) != on.end();
    });
    if (within) used.push_back(&run);
  }
  const std::size_t d = space_.dimensions(), m = calibration_.measurements.size();
  Table table{
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(used.size()),
                            static_cast<Eigen::Index>(d + on.size())),
      Eigen::MatrixXd(static_cast<Eigen::Index>(used.size()), static_cast<Eigen::Index>(m))};
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t k = 0; k < d; ++k) {
      table.inputs(row, static_cast<Eigen::Index>(k)) = used[i]->at[k];
    }
    for (std::size_t k = 0; k < on.size(); ++k) {
      const auto found = used[i]->strengths.find(on[k]);
      const double strength = found == used[i]->strengths.end() ? 0.0 : found->second;
      table.inputs(row, static_cast<Eigen::Index>(d + k)) = strength;
    }
    for (std::size_t j = 0; j < m; ++j) {
      table.outputs(row, static_cast<Eigen::Index>(j)) = used[i]->values[j];
    }
  }
  return table;
}

}  // namespace repose::calibrator
