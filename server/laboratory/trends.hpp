/// Trends: every observable of the laboratory while one parameter of the reference grain changes
/// and all others stay.
#pragma once

#include <map>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/experiment.hpp"
#include "server/laboratory/fidelity_pairs.hpp"

namespace repose::server {

/// A parameter, or a strength of an effect that has several, and the grains that have it.
struct TrendParameter {
  std::string name;   ///< "sliding_friction.coefficient"
  engine::Unit unit;  ///< of `values`
  std::vector<double> values;
  std::vector<engine::ParameterSet> grains;  ///< of each value
  std::map<std::string, double> settings;    ///< of every experiment, SI; others are usual
};

/// Material properties and contact laws of the reference grain over plausible ranges; then every
/// other effect of the catalogue from its null, in thirds, to a strong but plausible one.
std::vector<TrendParameter> trend_parameters(const engine::ParameterSet& reference);

/// "kettle.bulk_density" -> a reading for each grain, SI; NaN where there was none.
using Readings = std::map<std::string, std::vector<double>>;

struct Trends {
  engine::Fidelity fidelity = engine::Fidelity::draft;
  std::vector<TrendParameter> parameters;
  Readings reference;              ///< of several seeds
  std::vector<Readings> readings;  ///< of each parameter
  std::size_t missing = 0;         ///< runs not done, since it was asked to stop
};

/// At draft fidelity, one seed for each value and `reference_seeds` for the reference grain, whose
/// scatter tells what of a trend is none.
Trends measure_trends(const engine::ParameterSet& reference,
                      int reference_seeds,
                      Workers& workers,
                      const std::stop_token& stop,
                      const LaboratoryObserver& observer);

}  // namespace repose::server
