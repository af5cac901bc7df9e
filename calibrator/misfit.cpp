#include "calibrator/misfit.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/catalogue.hpp"

namespace repose::calibrator {

Suite::Suite(std::span<const Measurement> measurements) {
  for (const Measurement& measurement : measurements) {
    engine::Experiment experiment = measurement.experiment;
    experiment.fidelity = {};  // decided per evaluation, so it must not tell experiments apart
    auto found = std::ranges::find_if(experiments_, [&](const engine::Experiment& other) {
      return is_same_question(experiment, other);
    });
    if (found == experiments_.end()) found = experiments_.insert(found, std::move(experiment));
    readings_.push_back(
        {static_cast<std::size_t>(found - experiments_.begin()), measurement.observable});
  }
  for (std::size_t i = 0; i < experiments_.size(); ++i) {
    const engine::ExperimentInfo* info = engine::find_experiment(experiments_[i].name);
    if (info == nullptr) continue;
    for (const engine::ObservableInfo& observable : info->observables) {
      const auto measured = [&](const Reading& r) {
        return r.experiment == i && r.observable == observable.name;
      };
      if (std::ranges::any_of(readings_, measured)) continue;
      unmeasured_.push_back({i, std::string(observable.name), &observable});
    }
  }
}

std::optional<std::size_t> Suite::place_of(const engine::Experiment& experiment) const {
  const auto found = std::ranges::find_if(experiments_, [&](const engine::Experiment& own) {
    return is_same_question(experiment, own);
  });
  if (found == experiments_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - experiments_.begin());
}

void Suite::append_trials(const engine::ParameterSet& parameters,
                          engine::Fidelity fidelity,
                          std::uint64_t seed,
                          std::vector<engine::Trial>& trials) const {
  for (const engine::Experiment& experiment : experiments_) {
    trials.push_back({parameters, experiment, seed});
    trials.back().experiment.fidelity = fidelity;
  }
}

double Suite::read_one(const Reading& reading, std::span<const engine::Evaluation> evaluations) {
  const auto* observations =
      std::get_if<std::vector<engine::Observation>>(&evaluations[reading.experiment].outcome);
  if (observations != nullptr) {
    const auto found =
        std::ranges::find(*observations, reading.observable, &engine::Observation::name);
    if (found != observations->end() && std::isfinite(found->value)) return found->value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> Suite::read(std::span<const engine::Evaluation> evaluations) const {
  assert(evaluations.size() == experiments_.size());
  std::vector<double> values;
  for (const Reading& reading : readings_) values.push_back(read_one(reading, evaluations));
  return values;
}

std::vector<double> Suite::read_unmeasured(std::span<const engine::Evaluation> evaluations) const {
  assert(evaluations.size() == experiments_.size());
  std::vector<double> values;
  for (const Reading& reading : unmeasured_) values.push_back(read_one(reading, evaluations));
  return values;
}

std::vector<Suite::Unmeasured> Suite::unmeasured() const {
  std::vector<Unmeasured> result;
  for (const Reading& r : unmeasured_) result.push_back({experiments_[r.experiment], *r.info});
  return result;
}

double standard_uncertainty(const Measurement& measurement) {
  return std::hypot(measurement.standard_error, measurement.allowance);
}

std::vector<double> standardised_residuals(std::span<const Measurement> measurements,
                                           std::span<const double> observed) {
  assert(measurements.size() == observed.size());
  std::vector<double> z(measurements.size());
  for (std::size_t j = 0; j < z.size(); ++j) {
    z[j] = (observed[j] - measurements[j].value) / standard_uncertainty(measurements[j]);
  }
  return z;
}

double misfit(std::span<const Measurement> measurements, std::span<const double> observed) {
  const std::vector<double> z = standardised_residuals(measurements, observed);
  double sum = 0.0;
  for (std::size_t j = 0; j < z.size(); ++j) {
    if (measurements[j].role == Role::fit) sum += z[j] * z[j];
  }
  return sum;
}

}  // namespace repose::calibrator
