/// Trace: what a suspect changes in the fitted measurements, from the runs that probed it.
///
///   g = (mean over the runs with it - what the calibrated model gives there) / strength
///
/// What it does not touch it changes by nothing, with no scatter.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "calibrator/diagnosis/models.hpp"
#include "calibrator/diagnosis/suite_runs.hpp"

namespace repose::calibrator {

/// Whether a run had the suspect on and gave every fitted measurement that it touches.
bool observed(const SuiteRuns& runs,
              std::size_t suspect,
              const std::vector<Eigen::Index>& fitted,
              const SuiteRun& run);

struct Trace {
  Eigen::VectorXd change;    ///< SI, of each fitted measurement per unit of strength
  Eigen::VectorXd variance;  ///< of each change, from the scatter of the runs
};

/// `at`: where it was probed.
Trace trace_of(const SuiteRuns& runs,
               std::size_t suspect,
               const std::vector<Eigen::Index>& fitted,
               const Model& base,
               const Eigen::VectorXd& at);

}  // namespace repose::calibrator
