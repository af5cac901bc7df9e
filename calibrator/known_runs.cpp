#include "calibrator/known_runs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "calibrator/ledger.hpp"
#include "calibrator/misfit.hpp"
#include "engine/catalogue.hpp"

namespace repose::calibrator {
namespace {

using engine::ParameterSet;

/// Without the parameters that are at their null: to say that an effect is absent is to say
/// nothing.
ParameterSet without_nulls(const ParameterSet& set) {
  ParameterSet result;
  for (const auto& [key, value] : set) {
    const engine::ParameterInfo* info = engine::find_parameter(key.field);
    if (info != nullptr && value == info->field->null_value) continue;
    result.set(key, value);
  }
  return result;
}

/// The same but for the rounding of a way through the unit cube.
bool same(const ParameterSet& a, const ParameterSet& b) {
  return std::ranges::equal(a, b, [](const auto& x, const auto& y) {
    constexpr double rounding = 1e-9;
    return x.first == y.first &&
           std::abs(x.second - y.second) <= rounding * std::max(std::abs(x.second), 1e-30);
  });
}

std::optional<Level> level_of(const Calibration& calibration, engine::Fidelity fidelity) {
  if (fidelity == calibration.budget.fidelity) return Level::search;
  if (fidelity == calibration.budget.confirm_fidelity) return Level::confirm;
  return std::nullopt;
}

}  // namespace

bool has_set(const SearchSpace& space, const ParameterSet& parameters) {
  const ParameterSet here = space.at(space.coordinates(parameters));
  return same(without_nulls(here), without_nulls(parameters));
}

bool know_enough(const Ledger& ledger, int least) {
  for (std::size_t k = 0; k < ledger.space().dimensions(); ++k) {
    std::map<double, int> sites;
    int all = 0, commonest = 0;
    for (const Site& site : ledger.sites()) {
      if (!std::ranges::any_of(site.searched, &SiteRun::succeeded)) continue;
      ++all;
      commonest = std::max(commonest, ++sites[site.at[k]]);
    }
    if (all - commonest < least) return false;
  }
  return !ledger.sites().empty();
}

std::vector<KnownRun> known_runs(const Calibration& calibration,
                                 std::span<const engine::Evaluation> evaluations) {
  const SearchSpace space(calibration);
  const Suite suite(calibration.measurements);
  struct Run {
    const engine::Evaluation* first = nullptr;
    std::vector<const engine::Evaluation*> parts;
  };
  std::map<std::pair<std::uint64_t, std::size_t>, std::vector<Run>> by_seed;
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (const engine::Evaluation& evaluation : evaluations) {
    const auto place = suite.place_of(evaluation.trial.experiment);
    const auto level = level_of(calibration, evaluation.trial.experiment.fidelity);
    if (!place || !level) continue;
    const std::pair key{evaluation.trial.seed, static_cast<std::size_t>(*level)};
    std::vector<Run>& runs = by_seed[key];
    auto run = std::ranges::find_if(runs, [&](const Run& other) {
      return other.first->trial.parameters == evaluation.trial.parameters;
    });
    if (run == runs.end()) {
      if (runs.empty()) order.push_back(key);
      run = runs.insert(
          runs.end(), {&evaluation, std::vector<const engine::Evaluation*>(suite.size(), nullptr)});
    }
    run->parts[*place] = &evaluation;
  }
  std::vector<KnownRun> known;
  for (const auto& key : order) {
    for (const Run& run : by_seed[key]) {
      if (std::ranges::count(run.parts, nullptr) > 0) continue;
      const ParameterSet& parameters = run.first->trial.parameters;
      if (!has_set(space, parameters)) continue;
      std::vector<engine::Evaluation> parts;
      double grain_steps = 0.0;
      for (const engine::Evaluation* part : run.parts) {
        parts.push_back(*part);
        grain_steps += static_cast<double>(part->effort.grain_steps);
      }
      known.push_back({parameters, static_cast<Level>(key.second), suite.read(parts), grain_steps});
    }
  }
  return known;
}

std::vector<KnownRun> closest_runs(const Calibration& calibration,
                                   std::vector<KnownRun> known,
                                   std::size_t most) {
  if (most == 0 || known.size() <= most) return known;
  std::vector<double> ranked;
  for (const KnownRun& run : known) {
    const double q = misfit(calibration.measurements, run.values);
    ranked.push_back(std::isfinite(q) ? q : std::numeric_limits<double>::infinity());
  }
  std::vector<double> sorted = ranked;
  const auto last = sorted.begin() + static_cast<std::ptrdiff_t>(most) - 1;
  std::ranges::nth_element(sorted, last);
  std::vector<KnownRun> closest;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (closest.size() < most && ranked[i] <= *last) closest.push_back(std::move(known[i]));
  }
  return closest;
}

}  // namespace repose::calibrator
