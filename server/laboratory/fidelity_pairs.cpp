#include "server/laboratory/fidelity_pairs.hpp"

#include <cmath>
#include <limits>
#include <string_view>
#include <variant>

#include "calibrator/design.hpp"
#include "engine/catalogue.hpp"

namespace repose::server {

namespace {

using engine::Evaluation;
using engine::MaterialId;

constexpr std::array fidelities{engine::Fidelity::draft, engine::Fidelity::standard};

/// A parameter of the grain that the design spreads; with walls it is `at_wall` of that.
struct Range {
  std::string_view field;
  double lower, upper;
  double at_wall;  ///< 0: the parameter is the grain's alone
};

constexpr std::array ranges{Range{"restitution.coefficient", 0.3, 0.9, 1.0},
                            Range{"sliding_friction.coefficient", 0.2, 0.8, 2.0 / 3.0},
                            Range{"rolling_resistance.coefficient", 0.01, 0.12, 1.0},
                            Range{"size_spread.deviation", 0.0, 0.3, 0.0}};

double reading(const Evaluation& evaluation, std::size_t observable) {
  const auto* seen = std::get_if<std::vector<engine::Observation>>(&evaluation.outcome);
  return seen == nullptr ? std::numeric_limits<double>::quiet_NaN() : seen->at(observable).value;
}

}  // namespace

std::vector<engine::ParameterSet> spread_grains(const engine::ParameterSet& reference,
                                                std::size_t count) {
  std::vector<engine::ParameterSet> grains;
  for (const calibrator::UnitPoint& point :
       calibrator::spread_design(count, ranges.size(), /*seed=*/1)) {
    engine::ParameterSet& grain = grains.emplace_back(reference);
    for (std::size_t k = 0; k < ranges.size(); ++k) {
      const Range& range = ranges.at(k);
      const double value = range.lower + point[k] * (range.upper - range.lower);
      if (range.at_wall == 0.0) {
        grain.set(engine::make_key(range.field, {MaterialId::grain}), value);
        continue;
      }
      grain.set(engine::make_key(range.field, {MaterialId::grain, MaterialId::grain}), value);
      grain.set(engine::make_key(range.field, {MaterialId::grain, MaterialId::wall}),
                range.at_wall * value);
    }
  }
  return grains;
}

DraftBias FidelityPairs::bias() const {
  DraftBias bias{.mean = 0.0, .deviation = 0.0, .sets = 0};
  double squares = 0.0;
  for (const auto& [draft, standard] : readings) {
    const double difference = draft - standard;
    if (std::isnan(difference)) continue;
    // Welford's update of mean and sum of squares (Welford 1962, Technometrics 4, 419-420).
    const double before = difference - bias.mean;
    bias.mean += before / ++bias.sets;
    squares += before * (difference - bias.mean);
  }
  bias.deviation = bias.sets > 1 ? std::sqrt(squares / (bias.sets - 1))
                                 : std::numeric_limits<double>::quiet_NaN();
  if (bias.sets == 0) bias.mean = std::numeric_limits<double>::quiet_NaN();
  return bias;
}

std::vector<FidelityPairs> fidelity_pairs(const std::vector<engine::ParameterSet>& grains,
                                          Workers& workers,
                                          const std::stop_token& stop,
                                          const LaboratoryObserver& observer) {
  const auto catalogue = engine::experiment_catalogue();
  std::vector<engine::Trial> trials;
  for (const engine::ParameterSet& grain : grains) {
    for (const engine::ExperimentInfo& info : catalogue) {
      for (const engine::Fidelity fidelity : fidelities) {
        trials.push_back({grain, {std::string(info.name), fidelity, {}}, 1});
      }
    }
  }
  const std::vector<Evaluation> evaluations = workers.run(trials, stop, observer);

  std::vector<FidelityPairs> all;
  for (std::size_t e = 0; e < catalogue.size(); ++e) {
    const engine::ExperimentInfo& info = catalogue[e];
    for (std::size_t k = 0; k < info.observables.size(); ++k) {
      FidelityPairs pairs{std::string(info.name), info.observables[k], {}, 0.0};
      std::array<double, 2> steps{};
      for (std::size_t g = 0; g < grains.size(); ++g) {
        const std::size_t first = (g * catalogue.size() + e) * fidelities.size();
        pairs.readings.push_back(
            {reading(evaluations[first], k), reading(evaluations[first + 1], k)});
        if (std::isnan(pairs.readings.back()[0] - pairs.readings.back()[1])) continue;
        for (std::size_t f = 0; f < steps.size(); ++f) {
          steps.at(f) += static_cast<double>(evaluations[first + f].effort.grain_steps);
        }
      }
      pairs.cost = steps[0] / steps[1];
      all.push_back(std::move(pairs));
    }
  }
  return all;
}

}  // namespace repose::server
