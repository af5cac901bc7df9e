/// Comparison: the confirmed model against every measurement: how far off, with which share of each
/// uncertainty, along which condition, and whether that is more than chance.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/diagnosis/tolerance.hpp"
#include "calibrator/fit.hpp"

namespace repose::calibrator {

/// p below which a model does not fit.
inline constexpr double unlikely = 0.05;

/// One measurement against its prediction; all SI.
struct ComparedMeasurement {
  std::size_t measurement = 0;
  double predicted = 0.0;
  double difference = 0.0;         ///< predicted less measured
  double measurement_error = 0.0;  ///< standard error of the laboratory
  double tolerance = 0.0;          ///< how closely a code's word is taken
  double simulation_error = 0.0;   ///< of the mean of the confirming replicates
  double emulator_error = 0.0;  ///< of what the emulator had promised; not in z where runs confirm
  double z = 0.0;               ///< difference over the first three together
};

/// How the difference of one observable changes with a condition of its experiment.
struct ResidualTrend {
  std::string observable;  ///< "drop.restitution"
  std::string setting;     ///< "height"
  double slope = 0.0;      ///< of z per factor e of the setting (per unit where it crosses zero)
  double z = 0.0;          ///< of the slope
};

struct Comparison {
  std::vector<ComparedMeasurement> rows;  ///< in the order of the calibration
  std::vector<ResidualTrend> trends;
  double misfit = 0.0;      ///< of the fitted ones, shared tolerances accounted for
  double freedom = 0.0;     ///< fitted measurements less learnt directions
  double p = 1.0;           ///< that a right model misses by so much, estimated errors accounted
                            ///< for; without freedom that of a model that learnt nothing: such a
                            ///< misfit is told, and that it fits says nothing
  double fitted_z = 0.0;    ///< root mean square
  double held_out_z = 0.0;  ///< NaN where none is held out
  std::vector<std::string> sentences;  ///< where it is off, or that it fits
};

/// A setting's value for that measurement, the default where it is not given; NaN where there is
/// none.
double setting_of(const Measurement& measurement, const std::string& name);

/// Names of the settings in which the measurements of that observable differ.
std::vector<std::string> differing_settings(std::span<const Measurement> measurements,
                                            const std::string& observable);

Comparison compare(const Calibration& calibration, const Fit& fit, const Tolerances& stated = {});

}  // namespace repose::calibrator
