/// Numbers of a calibration as JSON, in its author's units. A parameter set is
/// [{"field", "between", "value", "unit"}, ...].
#pragma once

#include "calibrator/calibration.hpp"
#include "server/json/text.hpp"

namespace repose::server {

/// The unit in which the author thinks of a parameter, the catalogue's where they named none.
engine::Unit unit_of(const calibrator::Calibration& calibration, const engine::ParameterKey& key);

/// SI values of the measurements, in their order.
Json print_values(const calibrator::Calibration& calibration, const std::vector<double>& values);

Json print_parameter_set(const calibrator::Calibration& calibration,
                         const engine::ParameterSet& set);

/// Throws where an entry is none of ours.
engine::ParameterSet read_parameter_set(const Json& json);

}  // namespace repose::server
