/// Labels: what parameters and measurements are called in front of people.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "calibrator/calibration.hpp"

namespace repose::server {

/// "sliding friction (grain-wall)"
std::string parameter_label(const engine::ParameterKey& key);

/// "drum: dynamic angle"
std::string measurement_label(const calibrator::Measurement& measurement);

/// "speed 15 rpm, height 0.3 m"; empty where all settings are the defaults.
std::string settings_label(const engine::Experiment& experiment);

/// "speed 15 rpm": of the settings those in which the measurements of its observable differ; all
/// that it has where it is the only one.
std::string distinction_label(std::span<const calibrator::Measurement> measurements,
                              const calibrator::Measurement& own);

/// "drum: dynamic angle, 5 points along speed"; of a single measurement as above.
std::string line_label(std::span<const calibrator::Measurement> line);

/// The unit in which an observable is printed: as the study's author gave it, else the catalogue's.
engine::Unit observable_unit(const calibrator::Calibration& calibration,
                             std::string_view experiment,
                             std::string_view observable);

/// The unit in which a parameter is printed: as the study's author gave it, else the catalogue's.
engine::Unit parameter_unit(const calibrator::Calibration& calibration,
                            const engine::ParameterKey& key);

}  // namespace repose::server
