/// Charts of a published study that was run again, as SVG text.
#pragma once

#include <string>

#include "server/studies/study_result.hpp"

namespace repose::server {

/// Every run at (the paper's value, ours), with the line on which both are equal.
std::string agreement_chart(const StudyResult& result, const StudyExperiment& what);

/// Of every run of a table the change against the base, the paper's and ours, each with two
/// standard errors.
std::string change_chart(const StudyResult& result,
                         const StudyTable& table,
                         const StudyExperiment& what);

/// Of every variant of the base its value, between our base and the paper's.
std::string variant_chart(const StudyResult& result, const StudyExperiment& what);

/// Computing for a simulated second over the base's, the paper's and ours.
std::string cost_chart(const StudyResult& result, const StudyExperiment& what);

}  // namespace repose::server
