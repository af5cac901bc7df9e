#include "calibrator/diagnosis/tolerance.hpp"

#include <algorithm>
#include <cmath>

#include "engine/catalogue.hpp"

namespace repose::calibrator {

std::string observable_name(const Measurement& measurement) {
  return measurement.experiment.name + "." + measurement.observable;
}

double size_of(const Measurement& measurement) {
  if (measurement.unit.dimension == engine::unit::radian.dimension) {
    return std::abs(0.5 * std::sin(2.0 * measurement.value));
  }
  return std::abs(measurement.value);
}

double tolerance_of(const Measurement& measurement, const Tolerances& stated) {
  const auto own = stated.find(observable_name(measurement));
  if (own != stated.end()) return own->second;
  const engine::ExperimentInfo* experiment = engine::find_experiment(measurement.experiment.name);
  if (experiment == nullptr) return 0.0;
  const auto observable = std::ranges::find(
      experiment->observables, measurement.observable, &engine::ObservableInfo::name);
  return observable == experiment->observables.end() ? 0.0 : observable->code_spread;
}

double model_error_of(const Measurement& measurement, const Tolerances& stated) {
  return std::max(measurement.allowance, tolerance_of(measurement, stated) * size_of(measurement));
}

}  // namespace repose::calibrator
