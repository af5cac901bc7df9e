/// StudyResult: what came out when a published study was run again, beside what the paper printed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"
#include "engine/experiment.hpp"
#include "server/studies/study_plan.hpp"

namespace repose::server {

/// Replicates of one experiment at one parameter set.
struct Sample {
  std::vector<double> values;            ///< of those that gave one, in the paper's unit
  std::size_t failed = 0;                ///< replicates without a value
  std::string failure;                   ///< of the first of these, in words
  double grain_steps = 0.0;              ///< mean: spheres moved by a step, all that were read
  double simulated_seconds = 0.0;        ///< mean
  double time_step = 0.0;                ///< of the first, s
  double largest_overlap_at_rest = 0.0;  ///< over the radius

  [[nodiscard]] double mean() const;       ///< NaN of none
  [[nodiscard]] double deviation() const;  ///< of the values, n - 1; NaN of fewer than two
  [[nodiscard]] double error() const;      ///< standard error of the mean; NaN of fewer than two
};

/// By experiment.
using Samples = std::map<std::string, Sample>;

/// How a run lies to the base, in the paper and here.
struct Trend {
  double paper = 0.0;  ///< the paper's change against the base
  double ours = 0.0;
  /// Both changes have the same sign; none where there is no change, or a number is missing.
  std::optional<bool> agrees;
  bool paper_clear = false;  ///< the paper's change is above twice its standard error
  bool ours_clear = false;

  /// Whether the sign of both changes can be told.
  [[nodiscard]] bool clear() const { return paper_clear && ours_clear; }
};

/// Counts of trends.
struct TrendCount {
  int agree = 0, opposite = 0;
  int clear_agree = 0;                        ///< of these, those that are clear in both
  std::vector<std::string> clearly_opposite;  ///< runs that are opposite, and clear in both
};

struct VariantResult {
  std::string variant;
  Samples samples;
};

/// The best set that the calibrator found.
struct SearchResult {
  calibrator::Calibration calibration;
  calibrator::Fit fit;
  Samples samples;  ///< at the best set, fresh seeds
};

struct StudyResult {
  const PublishedStudy* study = nullptr;
  StudySize size = StudySize::full;
  std::string engine_version;
  std::map<std::string, Samples> runs;  ///< by run; drop test included
  std::vector<VariantResult> variants;
  std::optional<SearchResult> search;
  double grain_steps = 0.0;  ///< of all replicates together, repeated ones once a use
  std::size_t trials = 0;
  std::size_t missing = 0;  ///< of these not run, since the study was asked to stop

  /// Of a run; an empty sample where there is none.
  [[nodiscard]] const Sample& sample(const std::string& run, const std::string& experiment) const;
};

/// Against the base, in one experiment.
Trend trend(const StudyResult& result, const std::string& run, const StudyExperiment& experiment);

/// Over the runs of a table, each once, the base left out.
TrendCount count_trends(const StudyResult& result,
                        const StudyTable& table,
                        const StudyExperiment& experiment);

/// Computing for a simulated second over that of the base: the paper's from hours, ours from
/// sphere-steps. NaN where a number is missing.
struct CostRatio {
  double paper = 0.0;
  double ours = 0.0;
};
CostRatio cost_ratio(const StudyResult& result,
                     const std::string& run,
                     const std::string& experiment);

}  // namespace repose::server
