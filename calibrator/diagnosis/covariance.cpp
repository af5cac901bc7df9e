#include "calibrator/diagnosis/covariance.hpp"

#include "calibrator/misfit.hpp"

namespace repose::calibrator {

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
