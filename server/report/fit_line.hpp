/// FitLine: a row of a fit's tables and charts: one measurement with its prediction, or all points
/// of a curve.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"

namespace repose::server {

struct FitLine {
  std::span<const calibrator::Measurement> measured;
  std::span<const calibrator::Prediction> predicted;  ///< of each

  [[nodiscard]] bool is_curve() const { return measured.size() > 1; }
  [[nodiscard]] double z() const;           ///< of a curve the root mean square
  [[nodiscard]] double difference() const;  ///< SI, likewise
};

/// Those that have predictions.
std::vector<FitLine> lines_of(const calibrator::Calibration& calibration,
                              const calibrator::Fit& fit);

/// What was measured and what is predicted, with errors and unit: "720.7 ± 7.2 kg/m3"; of a curve
/// the ends: "30.1 to 34.0 deg".
std::string measured_text(const FitLine& line);
std::string predicted_text(const FitLine& line);
std::string difference_text(const FitLine& line);  ///< in the measurement's unit
std::string z_text(const FitLine& line);

}  // namespace repose::server
