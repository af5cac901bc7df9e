/// Study words: how the numbers of a study that was run again are written, on the terminal and in
/// the report alike.
#pragma once

#include <string>

#include "server/studies/study_result.hpp"

namespace repose::server {

/// "706.5 (1.2)": mean and standard deviation; a star where some replicates failed.
std::string sample_text(const Sample& sample);
std::string published_text(const PublishedNumber& number);

/// "agrees", "opposite"; with a ? where the change cannot be told from the scatter.
std::string trend_text(const Trend& trend);

/// So many digits after the point; "-" for NaN.
std::string known_text(double value, int decimals);

/// The same with its sign.
std::string signed_text(double value, int decimals);

/// "static angle"
std::string observable_text(const StudyExperiment& what);

}  // namespace repose::server
