#include "calibrator/diagnosis/covariance.hpp"

#include <limits>

namespace repose::calibrator {

Eigen::MatrixXd covariance_of(std::span<const Measurement> measurements, const Tolerances& stated) {
  const auto count = static_cast<Eigen::Index>(measurements.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Measurement& a = measurements[static_cast<std::size_t>(i)];
    const double tau = tolerance_of(a, stated) * size_of(a);
    for (Eigen::Index j = 0; j < i; ++j) {
      const Measurement& b = measurements[static_cast<std::size_t>(j)];
      if (observable_name(a) != observable_name(b)) continue;
      covariance(i, j) = covariance(j, i) =
          shared_tolerance * tau * tolerance_of(b, stated) * size_of(b);
    }
    const double model = model_error_of(a, stated);
    covariance(i, i) = a.standard_error * a.standard_error + model * model;
  }
  return covariance;
}

Eigen::VectorXd freedom_of(std::span<const Measurement> measurements,
                           const Eigen::VectorXd& variance) {
  Eigen::VectorXd freedom =
      Eigen::VectorXd::Constant(variance.size(), std::numeric_limits<double>::infinity());
  for (Eigen::Index j = 0; j < freedom.size(); ++j) {
    const Measurement& measurement = measurements[static_cast<std::size_t>(j)];
    if (measurement.replicates < 2 || !(measurement.standard_error > 0.0)) continue;
    const double share = variance(j) / (measurement.standard_error * measurement.standard_error);
    freedom(j) = (measurement.replicates - 1.0) * share * share;
  }
  return freedom;
}

}  // namespace repose::calibrator
