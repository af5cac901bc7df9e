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

struct Before {
  bool operator()(const ParameterSet* a, const ParameterSet* b) const {
    return std::ranges::lexicographical_compare(*a, *b);
  }
};

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
  // In the order of what was asked, not of when it was answered.
  using Parts = std::vector<const engine::Evaluation*>;
  std::map<std::pair<std::uint64_t, Level>, std::map<const ParameterSet*, Parts, Before>> runs;
  for (const engine::Evaluation& evaluation : evaluations) {
    const auto place = suite.place_of(evaluation.trial.experiment);
    const auto level = level_of(calibration, evaluation.trial.experiment.fidelity);
    if (!place || !level) continue;
    auto& of_seed = runs[{evaluation.trial.seed, *level}];
    Parts& parts = of_seed[&evaluation.trial.parameters];
    parts.resize(suite.size(), nullptr);
    parts[*place] = &evaluation;
  }
  std::vector<KnownRun> known;
  for (const auto& [seed_and_level, of_seed] : runs) {
    for (const auto& [parameters, parts] : of_seed) {
      if (std::ranges::count(parts, nullptr) > 0 || !has_set(space, *parameters)) continue;
      std::vector<engine::Evaluation> answers;
      double grain_steps = 0.0;
      for (const engine::Evaluation* part : parts) {
        answers.push_back(*part);
        grain_steps += static_cast<double>(part->effort.grain_steps);
      }
      known.push_back({*parameters, seed_and_level.second, suite.read(answers), grain_steps});
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
