/// Progress: how a running calibration is shown: a display that renews itself on a terminal, a line
/// a batch on a pipe.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <ostream>
#include <string>
#include <thread>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"

namespace repose::server {

/// All that is known at one moment.
struct ProgressView {
  std::string stage;
  int evaluations_done = 0;
  int evaluations_planned = 0;
  std::size_t trials_done = 0;  ///< of the batch
  std::size_t trials_all = 0;   ///< of the batch
  std::size_t trials_per_evaluation = 1;
  std::size_t trials_run = 0;     ///< not found in the store, since the start
  std::size_t trials_stored = 0;  ///< found in the store, since the start
  double elapsed = 0.0;           ///< s
  double misfit = 0.0;            ///< NaN before there is one
  std::vector<double> predicted;  ///< SI, per measurement
  std::vector<double> z;          ///< per measurement
};

/// Estimated from the trials that were run here; negative before there is one. s
double time_left(const ProgressView& view);

/// The display: a few lines without newlines, each at most `width` letters.
std::vector<std::string> progress_lines(const calibrator::Calibration& calibration,
                                        const ProgressView& view,
                                        std::size_t width);

/// One line for a log.
std::string progress_line(const ProgressView& view);

class ProgressDisplay {
 public:
  /// `live` where `out` is a terminal that understands cursor movements.
  ProgressDisplay(const calibrator::Calibration& calibration, std::ostream& out, bool live);
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// From any thread.
  void progress(const calibrator::Progress& progress);
  void trial(std::size_t done, std::size_t all, bool stored);

  /// Removes the live display, so that results can follow.
  void finish();

 private:
  void draw();
  void erase();
  void tick(const std::stop_token& stop);

  const calibrator::Calibration& calibration_;
  std::ostream& out_;
  const bool live_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::mutex mutex_;  // guards what follows
  ProgressView view_;
  std::size_t lines_drawn_ = 0;
  std::jthread ticker_;
};

}  // namespace repose::server
