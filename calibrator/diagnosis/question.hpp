/// DiagnosisQuestion: all that a diagnosis is told of a calibration, its data and what may be
/// missing.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "calibrator/calibration.hpp"
#include "calibrator/diagnosis/deciding_measurement.hpp"
#include "calibrator/diagnosis/diagnosis.hpp"
#include "calibrator/fit.hpp"

namespace repose::calibrator {

struct DiagnosisQuestion {
  const Calibration& calibration;  ///< outlives the question, as the fit does
  const Fit& fit;
  std::vector<Suspect> suspects;
  Eigen::MatrixXd covariance;     ///< of all measurements, SI: standard errors and tolerances
  Eigen::VectorXd sizes;          ///< SI: what 100 % of each measurement is
  Eigen::VectorXd error_freedom;  ///< of each one's variance; infinite where it is known
  Eigen::VectorXd offset;         ///< SI: what the laboratory's apparatus adds to the runs'
  std::vector<Candidate> candidates = {};  ///< that could be measured next
};

/// The question with the catalogue's suspects and the stated tolerances.
DiagnosisQuestion question_of(const Calibration& calibration,
                              const Fit& fit,
                              const Tolerances& stated = {});

}  // namespace repose::calibrator
