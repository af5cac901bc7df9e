#include "calibrator/diagnosis/question.hpp"

#include <cmath>

#include "calibrator/diagnosis/covariance.hpp"

namespace repose::calibrator {

DiagnosisQuestion question_of(const Calibration& calibration,
                              const Fit& fit,
                              const Tolerances& stated) {
  const auto count = static_cast<Eigen::Index>(calibration.measurements.size());
  DiagnosisQuestion question{calibration,
                             fit,
                             suspects_of(calibration, fit.best),
                             covariance_of(calibration.measurements, stated),
                             Eigen::VectorXd(count),
                             Eigen::VectorXd(count),
                             Eigen::VectorXd::Zero(count),
                             candidates_of(calibration, stated)};
  for (Eigen::Index j = 0; j < count; ++j) {
    const Measurement& measurement = calibration.measurements[static_cast<std::size_t>(j)];
    question.sizes(j) = size_of(measurement);
    if (static_cast<std::size_t>(j) < fit.offset.size()) {
      question.offset(j) = fit.offset[static_cast<std::size_t>(j)];
    }
    if (static_cast<std::size_t>(j) < fit.offset_error.size()) {
      question.covariance(j, j) += std::pow(fit.offset_error[static_cast<std::size_t>(j)], 2);
    }
  }
  question.error_freedom = freedom_of(calibration.measurements, question.covariance.diagonal());
  return question;
}

}  // namespace repose::calibrator
