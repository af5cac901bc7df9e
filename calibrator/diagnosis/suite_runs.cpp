#include "calibrator/diagnosis/suite_runs.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "engine/random.hpp"

namespace repose::calibrator {
namespace {

constexpr auto left_out = std::numeric_limits<std::size_t>::max();

}  // namespace

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
    runs_.push_back({space_.coordinates(point.parameters), {}, point.values, 0});
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
  std::vector<std::uint64_t> seeds;
  for (int pair = 0; pair < count; ++pair) {
    const std::uint64_t seed = seeds.emplace_back(next_seed());
    suite_.append_trials(parameters, calibration_.budget.fidelity, seed, trials);
    suite_.append_trials(parameters, other, seed, trials);
    ++spent_;
  }
  const std::vector<engine::Evaluation> evaluations = evaluator_(trials);
  std::span rest(evaluations);
  std::vector<std::vector<double>> differences;
  for (const std::uint64_t seed : seeds) {
    runs_.push_back({at, {}, suite_.read(rest.first(suite_.size())), seed});
    differences.push_back(suite_.read(rest.subspan(suite_.size(), suite_.size())));
    for (std::size_t j = 0; j < differences.back().size(); ++j) {
      differences.back()[j] -= runs_.back().values[j];
    }
    rest = rest.subspan(2 * suite_.size());
  }
  return differences;
}

/// A run in which none is on is one of the calibrated model.
bool SuiteRuns::touched(std::size_t experiment, const Strengths& strengths) const {
  bool none = true;
  for (const auto& [suspect, strength] : strengths) {
    if (strength == 0.0) continue;
    none = false;
    if (!untouched_.contains({suspect, experiment})) return true;
  }
  return none;
}

bool SuiteRuns::touches(std::size_t suspect, std::size_t measurement) const {
  return !untouched_.contains({suspect, suite_.experiment_of(measurement)});
}

/// Of a run with one suspect against that with the same seed and none.
void SuiteRuns::learn_incidence(SuiteRun& run) {
  const auto without = std::ranges::find_if(runs_, [&](const SuiteRun& other) {
    return other.seed == run.seed && other.at == run.at && other.strengths.empty();
  });
  if (without == runs_.end() || run.strengths.size() != 1) return;
  for (std::size_t e = 0; e < suite_.size(); ++e) {
    bool equal = true;
    for (std::size_t j = 0; j < run.values.size(); ++j) {
      equal &= suite_.experiment_of(j) != e || run.values[j] == without->values[j];  // NaN is not
    }
    if (!equal) continue;
    untouched_.emplace(run.strengths.begin()->first, e);
    for (std::size_t j = 0; j < run.values.size(); ++j) {
      // It was the same run, and tells nothing twice.
      if (suite_.experiment_of(j) == e) run.values[j] = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

void SuiteRuns::run(std::span<const Point> points) {
  std::vector<engine::Trial> trials;
  std::vector<SuiteRun> asked;
  std::vector<std::vector<std::size_t>> places;  // of its experiments among the trials
  for (const Point& point : points) {
    const std::uint64_t own = next_seed();
    SuiteRun run{point.at, {}, {}, point.seed.value_or(own)};
    engine::ParameterSet parameters = space_.at(point.at);
    for (const auto& [suspect, strength] : point.strengths) {
      const double snapped = suspects_[suspect].snapped(strength);
      suspects_[suspect].apply(parameters, snapped);
      run.strengths[suspect] = snapped;
    }
    std::vector<engine::Trial> whole;
    suite_.append_trials(parameters, calibration_.budget.fidelity, run.seed, whole);
    places.emplace_back(whole.size(), left_out);
    for (std::size_t e = 0; e < whole.size(); ++e) {
      if (!touched(e, run.strengths)) continue;
      places.back()[e] = trials.size();
      trials.push_back(std::move(whole[e]));
    }
    asked.push_back(std::move(run));
  }
  const std::vector<engine::Evaluation> evaluations = evaluator_(trials);
  assert(evaluations.size() == trials.size());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    std::vector<engine::Evaluation> whole(suite_.size());
    for (std::size_t e = 0; e < whole.size(); ++e) {
      if (places[i][e] != left_out) whole[e] = evaluations[places[i][e]];
    }
    asked[i].values = suite_.read(whole);
    if (points[i].seed) learn_incidence(asked[i]);
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
  Table table{Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(used.size()),
                                    static_cast<Eigen::Index>(d + on.size())),
              Eigen::MatrixXd(static_cast<Eigen::Index>(used.size()), static_cast<Eigen::Index>(m)),
              std::vector<std::vector<Eigen::Index>>(m)};
  for (std::size_t j = 0; j < m; ++j) {
    for (std::size_t k = 0; k < d + on.size(); ++k) {
      if (k < d || touches(on[k - d], j)) table.heard[j].push_back(static_cast<Eigen::Index>(k));
    }
  }
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
