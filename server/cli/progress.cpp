#include "server/cli/progress.hpp"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <limits>
#include <sstream>
#include <stop_token>
#include <sys/ioctl.h>
#include <unistd.h>

#include "server/cli/text_table.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Measurement;

namespace {

std::string cut(const std::string& line, std::size_t width) {
  if (letters(line) <= width) return line;
  std::string text;
  for (const char c : line) {
    const bool starts_letter = (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    if (starts_letter && letters(text) + 1 > width) break;
    text += c;
  }
  return text;
}

std::string bar(double share, std::size_t width) {
  const double full = std::clamp(share, 0.0, 1.0) * static_cast<double>(width);
  const auto done = static_cast<std::size_t>(std::lround(full));
  std::string text;
  for (std::size_t i = 0; i < width; ++i) text += i < done ? "█" : "░";
  return text;
}

std::string left_text(const ProgressView& view) {
  const double left = time_left(view);
  return left < 0.0 ? "not known yet" : "about " + duration_text(left);
}

std::size_t terminal_width() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 20) return 80;
  return size.ws_col;
}

std::size_t count_experiments(const Calibration& calibration) {
  std::vector<engine::Experiment> distinct;
  for (const Measurement& measurement : calibration.measurements) {
    if (std::ranges::find(distinct, measurement.experiment) == distinct.end()) {
      distinct.push_back(measurement.experiment);
    }
  }
  return std::max<std::size_t>(1, distinct.size());
}

}  // namespace

double time_left(const ProgressView& view) {
  if (view.trials_run == 0) return -1.0;
  const double each = view.elapsed / static_cast<double>(view.trials_run);
  const double evaluations = std::max(0, view.evaluations_planned - view.evaluations_done);
  const double trials = evaluations * static_cast<double>(view.trials_per_evaluation) -
                        static_cast<double>(view.trials_done);
  return each * std::max(0.0, trials);
}

std::vector<std::string> progress_lines(const Calibration& calibration,
                                        const ProgressView& view,
                                        std::size_t width) {
  std::vector<std::string> lines;
  const double planned = std::max(1, view.evaluations_planned);
  lines.push_back(bar(view.evaluations_done / planned, 28) + "  " +
                  std::to_string(view.evaluations_done) + " of " +
                  std::to_string(view.evaluations_planned) + " evaluations  " + view.stage);
  lines.push_back("batch " + std::to_string(view.trials_done) + " of " +
                  std::to_string(view.trials_all) + " trials   elapsed " +
                  duration_text(view.elapsed) + "   left " + left_text(view));
  if (view.trials_stored > 0)
    lines.back() += "   from the store " + std::to_string(view.trials_stored);
  if (std::isfinite(view.misfit)) {
    lines.push_back("best expected misfit " + number_text(view.misfit, 3));
    TextTable table({"measurement", "measured", "predicted", "z"});
    for (std::size_t i = 0; i < view.predicted.size(); ++i) {
      const Measurement& measurement = calibration.measurements.at(i);
      const double factor = measurement.unit.factor;
      const int decimals =
          decimals_for(measurement.value / factor, measurement.standard_error / factor);
      table.row({measurement_label(measurement),
                 with_error(measurement.value, measurement.standard_error, measurement.unit),
                 fixed_text(view.predicted[i] / factor, decimals) + unit_suffix(measurement.unit),
                 i < view.z.size() ? fixed_text(view.z[i], 1) : "-"});
    }
    std::istringstream rows(table.str());
    for (std::string row; std::getline(rows, row);) lines.push_back("  " + row);
  }
  for (std::string& line : lines) line = cut(line, width);
  return lines;
}

std::string progress_line(const ProgressView& view) {
  std::string line = std::to_string(view.evaluations_done) + "/" +
                     std::to_string(view.evaluations_planned) + " evaluations, " + view.stage;
  if (std::isfinite(view.misfit)) line += ", best expected misfit " + number_text(view.misfit, 3);
  line += ", elapsed " + duration_text(view.elapsed);
  if (time_left(view) >= 0.0) line += ", left " + left_text(view);
  if (view.trials_stored > 0) line += ", " + std::to_string(view.trials_stored) + " from the store";
  return line;
}

ProgressDisplay::ProgressDisplay(const Calibration& calibration, std::ostream& out, bool live)
    : calibration_(calibration), out_(out), live_(live) {
  view_.stage = "starting";
  view_.evaluations_planned = calibration.budget.evaluations;
  view_.trials_per_evaluation = count_experiments(calibration);
  view_.misfit = std::numeric_limits<double>::quiet_NaN();
  if (live_) ticker_ = std::jthread([this](const std::stop_token& stop) { tick(stop); });
}

ProgressDisplay::~ProgressDisplay() { finish(); }

void ProgressDisplay::progress(const calibrator::Progress& progress) {
  const std::scoped_lock lock(mutex_);
  view_.stage = progress.stage;
  view_.evaluations_done = progress.evaluations_done;
  view_.evaluations_planned = progress.evaluations_planned;
  view_.misfit = progress.misfit;
  view_.predicted = progress.predicted;
  view_.z = progress.z;
  view_.trials_done = view_.trials_all = 0;
  draw();
}

void ProgressDisplay::trial(std::size_t done, std::size_t all, bool stored) {
  const std::scoped_lock lock(mutex_);
  view_.trials_done = done;
  view_.trials_all = all;
  ++(stored ? view_.trials_stored : view_.trials_run);
  if (live_) draw();
}

void ProgressDisplay::finish() {
  if (ticker_.joinable()) {
    ticker_.request_stop();
    ticker_.join();
  }
  const std::scoped_lock lock(mutex_);
  erase();
  out_.flush();
}

void ProgressDisplay::draw() {
  view_.elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  if (!live_) {
    out_ << progress_line(view_) << std::endl;
    return;
  }
  erase();
  const auto lines = progress_lines(calibration_, view_, terminal_width() - 1);
  for (const std::string& line : lines) out_ << line << "\n";
  lines_drawn_ = lines.size();
  out_.flush();
}

void ProgressDisplay::erase() {
  // Cursor up by so many lines, to the first column, clear to the end of the screen (ECMA-48).
  if (lines_drawn_ > 0) out_ << "\x1b[" << lines_drawn_ << "F\x1b[J";
  lines_drawn_ = 0;
}

void ProgressDisplay::tick(const std::stop_token& stop) {
  std::mutex waiting;
  std::condition_variable_any wake;
  std::unique_lock lock(waiting);
  while (!stop.stop_requested()) {
    {
      const std::scoped_lock drawing(mutex_);
      draw();
    }
    wake.wait_for(lock, stop, std::chrono::seconds(1), [] { return false; });
  }
}

}  // namespace repose::server
