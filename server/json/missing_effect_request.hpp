/// What may be asked about a missing effect: documents <-> values, with all problems at once.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibrator/diagnosis/diagnosis.hpp"
#include "engine/result.hpp"
#include "server/json/problem.hpp"

namespace repose::server {

/// "EXPERIMENT.OBSERVABLE" of the whole catalogue: what a tolerance can be of.
const std::vector<std::string>& observable_names();

/// {"tolerances": {"EXPERIMENT.OBSERVABLE": SHARE}}, as it is kept beside a diagnosis.
std::string print_diagnosis_request(const calibrator::Tolerances& stated);
engine::Result<calibrator::Tolerances, Problems> parse_diagnosis_request(std::string_view text);

/// {"effect", "diagnosis"}: which effect to add, and whose runs to start from.
struct ExtensionRequest {
  std::string effect;
  std::optional<std::int64_t> diagnosis;
};
engine::Result<ExtensionRequest, Problems> parse_extension_request(std::string_view text);

std::string print_diagnosis_progress(const calibrator::DiagnosisProgress& progress);

}  // namespace repose::server
