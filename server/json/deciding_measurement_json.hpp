/// Measurements that would settle a diagnosis, as part of its document.
#pragma once

#include "calibrator/diagnosis/diagnosis.hpp"
#include "server/json/text.hpp"

namespace repose::server {

/// {"experiment","settings","observable","unit","standard_error","evidence","gain",
///  "expected":[{"model":[EFFECT...],"value"}...]}
Json print_next(const calibrator::Diagnosis& diagnosis,
                const calibrator::DecidingMeasurement& next);

/// The effects of the diagnosis are read before; its rivals are read with the first measurement.
void read_next(const Json& json, calibrator::Diagnosis& diagnosis);

}  // namespace repose::server
