/// Diagnosis <-> document (schemas/diagnosis.schema.json): numbers in the units of the
/// calibration's author; a probability is never 0 but at most the share that its draws can tell.
#pragma once

#include <string>
#include <string_view>

#include "calibrator/calibration.hpp"
#include "calibrator/diagnosis/diagnosis.hpp"
#include "calibrator/diagnosis/tolerance.hpp"
#include "engine/result.hpp"

namespace repose::server {

std::string print_diagnosis(const calibrator::Calibration& calibration,
                            const calibrator::Tolerances& stated,
                            const calibrator::Diagnosis& diagnosis);

/// Reads what print_diagnosis() printed for the same calibration; the error is a sentence.
engine::Result<calibrator::Diagnosis, std::string> parse_diagnosis(
    const calibrator::Calibration& calibration, std::string_view text);

}  // namespace repose::server
