#include "calibrator/diagnosis/tolerance.hpp"

#include <algorithm>
#include <cmath>

#include "calibrator/misfit.hpp"
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

Eigen::MatrixXd covariance_of(std::span<const Measurement> measurements, const Tolerances& stated) {
  const auto count = static_cast<Eigen::Index>(measurements.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(count, count);
  constexpr double shared = 0.75;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Measurement& a = measurements[static_cast<std::size_t>(i)];
    const double tau = tolerance_of(a, stated) * size_of(a);
    for (Eigen::Index j = 0; j < i; ++j) {
      const Measurement& b = measurements[static_cast<std::size_t>(j)];
      if (observable_name(a) != observable_name(b)) continue;
      covariance(i, j) = covariance(j, i) = shared * tau * tolerance_of(b, stated) * size_of(b);
    }
    const double own = standard_uncertainty(a);
    covariance(i, i) = own * own + tau * tau;
  }
  return covariance;
}

}  // namespace repose::calibrator
