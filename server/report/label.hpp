/// Labels: what parameters and measurements are called in front of people.
#pragma once

#include <string>

#include "calibrator/calibration.hpp"

namespace repose::server {

/// "sliding friction (grain-wall)"
std::string parameter_label(const engine::ParameterKey& key);

/// "drum: dynamic angle"
std::string measurement_label(const calibrator::Measurement& measurement);

/// "speed 15 rpm, height 0.3 m"; empty where all settings are the defaults.
std::string settings_label(const engine::Experiment& experiment);

/// The unit in which a parameter is printed: as the study's author gave it, else the catalogue's.
engine::Unit parameter_unit(const calibrator::Calibration& calibration,
                            const engine::ParameterKey& key);

}  // namespace repose::server
