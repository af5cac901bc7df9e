#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "server/report/chart.hpp"
#include "server/report/number_text.hpp"
#include "server/report/svg.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Fit;
using calibrator::HistoryPoint;

namespace {

constexpr double width = 480.0, height = 320.0;  // pixels at full size, as all below
constexpr double left = 46.0, right = width - 10.0, top = 28.0, bottom = height - 70.0;

constexpr std::array<std::string_view, 5> stages{"start", "replicate", "pair", "search", "confirm"};

/// Where the axes lead.
struct Scales {
  double evaluations;      ///< at the right end
  double lowest, highest;  ///< misfit, powers of ten

  [[nodiscard]] double x(double evaluation) const {
    return left + (right - left) * evaluation / evaluations;
  }
  [[nodiscard]] double y(double misfit) const {
    const double place = std::clamp(std::log10(std::max(misfit, 1e-300)), lowest, highest);
    return bottom - (bottom - top) * (place - lowest) / (highest - lowest);
  }
};

Scales scales_of(const Fit& fit, double fitted) {
  constexpr double least = 0.01;  // of the expected misfit; below, the curve says nothing more
  double lowest = fitted, highest = fitted;
  for (const HistoryPoint& point : fit.history) {
    for (const double misfit : {point.misfit, point.best}) {
      if (!(misfit >= 0.0) || !std::isfinite(misfit)) continue;
      lowest = std::min(lowest, std::max(misfit, least * fitted));
      highest = std::max(highest, misfit);
    }
  }
  const double last = fit.history.empty() ? 1.0 : fit.history.back().evaluation;
  return {std::max(1.0, last) + 0.5,
          std::floor(std::log10(lowest)),
          std::ceil(std::log10(1.2 * highest))};
}

void draw_axes(Svg& svg, const Scales& scales, double fitted) {
  for (int power = static_cast<int>(scales.lowest); power <= scales.highest; ++power) {
    const double y = scales.y(std::pow(10.0, power));
    svg.line(left, y, right, y, "grid");
    svg.text(left - 6.0, y + 4.0, number_text(std::pow(10.0, power)), "end", "tick right");
  }
  for (const auto& [place, words] : ticks(0.0, scales.evaluations, 6)) {
    svg.line(scales.x(place), bottom, scales.x(place), bottom + 4.0, "axis");
    svg.text(scales.x(place), bottom + 17.0, words, "middle", "tick");
  }
  svg.line(left, bottom, right, bottom, "axis");
  svg.text(0.5 * (left + right), bottom + 34.0, "evaluation", "middle", "quiet");
  svg.text(0.0, 10.0, "misfit (sum of z²)", "start", "quiet left");
  svg.line(left, scales.y(fitted), right, scales.y(fitted), "expected");
  svg.text(left + 6.0, scales.y(fitted) + 14.0, "expected of a right model", "start", "tick left");
}

void draw_points(Svg& svg, const Fit& fit, const Scales& scales) {
  std::vector<std::pair<double, double>> best;
  for (const HistoryPoint& point : fit.history) {
    const double x = scales.x(point.evaluation);
    if (std::isfinite(point.best)) {
      if (!best.empty()) best.emplace_back(x, best.back().second);
      best.emplace_back(x, scales.y(point.best));
    }
  }
  svg.polyline(best, "expectation");
  for (const HistoryPoint& point : fit.history) {
    const double x = scales.x(point.evaluation);
    if (!std::isfinite(point.misfit)) {
      svg.line(x - 3.5, top - 3.5, x + 3.5, top + 3.5, "failed");
      svg.line(x - 3.5, top + 3.5, x + 3.5, top - 3.5, "failed");
      continue;
    }
    svg.circle(x,
               scales.y(point.misfit),
               4.0,
               "stage " + std::string(point.stage),
               "evaluation " + std::to_string(point.evaluation) + ", " + std::string(point.stage) +
                   ", misfit " + number_text(point.misfit, 3));
  }
}

void draw_legend(Svg& svg, const Fit& fit) {
  double x = left;
  const double y = height - 12.0;
  for (const std::string_view stage : stages) {
    if (std::ranges::find(fit.history, stage, &HistoryPoint::stage) == fit.history.end()) continue;
    svg.circle(x + 4.0, y - 4.0, 4.0, "stage " + std::string(stage));
    svg.text(x + 12.0, y, stage, "start", "tick left");
    x += 26.0 + 6.4 * static_cast<double>(stage.size());
  }
  x = fit.failed > 0 ? right - 180.0 : right - 112.0;
  svg.line(x, 6.0, x + 18.0, 6.0, "expectation");
  svg.text(x + 23.0, 10.0, "best expected", "start", "tick left");
  if (fit.failed == 0) return;
  x += 124.0;
  svg.line(x, 2.5, x + 7.0, 9.5, "failed");
  svg.line(x, 9.5, x + 7.0, 2.5, "failed");
  svg.text(x + 12.0, 10.0, "failed", "start", "tick left");
}

}  // namespace

std::string convergence_chart(const Calibration& calibration, const Fit& fit) {
  const auto fitted = static_cast<double>(std::max<std::ptrdiff_t>(
      1,
      std::ranges::count(
          calibration.measurements, calibrator::Role::fit, &calibrator::Measurement::role)));
  const Scales scales = scales_of(fit, fitted);
  Svg svg(width, height, "Misfit against evaluation");
  draw_axes(svg, scales, fitted);
  draw_points(svg, fit, scales);
  draw_legend(svg, fit);
  return svg.str();
}

}  // namespace repose::server
