/// Findings: what a study that was run again says, as rows and sentences, for text, JSON and HTML.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/studies/study_result.hpp"

namespace repose::server {

/// The drop test of a run: what restitution was given, what was read.
struct DropRow {
  std::string run;
  double given = 0.0;
  double read = 0.0;     ///< NaN where it failed
  double percent = 0.0;  ///< deviation of the one from the other, %
  std::optional<DropAccuracy> paper;
};
std::vector<DropRow> drop_rows(const StudyResult& result);

/// A variant of the base against the gap between the paper's base and ours.
struct Explained {
  Sample sample;
  double change = 0.0;  ///< variant less base, both ours
  double error = 0.0;   ///< of the change
  double share = 0.0;   ///< of the gap: change / (paper's base - our base)
  double left = 0.0;    ///< variant less the paper's base
};
/// Nothing where the variant was not run in that experiment.
std::optional<Explained> explain(const StudyResult& result,
                                 const std::string& variant,
                                 const StudyExperiment& experiment);

/// The study's answer in sentences.
std::vector<std::string> findings(const StudyResult& result);

}  // namespace repose::server
