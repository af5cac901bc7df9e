#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "server/report/axis.hpp"
#include "server/report/chart.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"
#include "server/report/svg.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Fit;
using calibrator::Measurement;
using calibrator::Prediction;

namespace {

constexpr double width = 480.0;  // pixels at full size, as all below

double uncertainty(const Measurement& measurement) {
  return std::hypot(measurement.standard_error, measurement.allowance);
}

void draw_parity_row(Svg& svg,
                     double top,
                     const Measurement& measurement,
                     const Prediction& prediction) {
  const double factor = measurement.unit.factor;
  const double measured = measurement.value / factor, u = uncertainty(measurement) / factor;
  const double predicted = prediction.predicted / factor;
  const double error = prediction.standard_error / factor;
  const double reach = std::max(3.0 * u, 1.15 * (std::abs(predicted - measured) + error));
  const Axis x{measured - reach, measured + reach, 8.0, width - 8.0};
  const double middle = top + 34.0;
  svg.text(x.from,
           top + 12.0,
           measurement_label(measurement) + (held_out(measurement) ? " (held out)" : ""),
           "start",
           "label");
  svg.text(x.to, top + 12.0, unit_suffix(measurement.unit), "end", "quiet");
  svg.rect(x(measured - 2.0 * u), middle - 12.0, x(2.0 * u) - x(-2.0 * u), 24.0, "band two");
  svg.rect(x(measured - u), middle - 12.0, x(u) - x(-u), 24.0, "band one");
  svg.line(x(measured), middle - 12.0, x(measured), middle + 12.0, "measured");
  svg.line(x.from, middle + 12.0, x.to, middle + 12.0, "axis");
  for (const auto& [place, words] : ticks(x.lower, x.upper, 5)) {
    svg.line(x(place), middle + 12.0, x(place), middle + 16.0, "axis");
    const double edge = std::clamp(x(place), x.from + 14.0, x.to - 14.0);
    svg.text(edge, middle + 28.0, words, "middle", "tick");
  }
  if (std::isnan(predicted)) return;
  const std::string style = std::string("dot ") + grade(prediction.z);
  svg.line(x(predicted - error), middle, x(predicted + error), middle, "whisker");
  svg.line(x(predicted - error), middle - 4.0, x(predicted - error), middle + 4.0, "whisker");
  svg.line(x(predicted + error), middle - 4.0, x(predicted + error), middle + 4.0, "whisker");
  svg.circle(
      x(predicted),
      middle,
      5.5,
      held_out(measurement) ? style + " hollow" : style,
      "predicted " + with_error(prediction.predicted, prediction.standard_error, measurement.unit));
}

void draw_residual(Svg& svg, double top, const Axis& x, const FitLine& line) {
  const Measurement& measurement = line.measured.front();
  std::string note = held_out(measurement) ? "held out" : settings_label(measurement.experiment);
  if (line.is_curve()) {
    note = std::to_string(line.measured.size()) + " points, root mean square";
  }
  const double shift = note.empty() ? 0.0 : -6.0;
  svg.text(0.0, top + 25.0 + shift, measurement_label(measurement), "start", "label small");
  svg.text(0.0, top + 33.0, note, "start", "tick left");
  const double z = line.z(), reach = x.upper;
  if (!std::isfinite(z)) return;
  const double end = x(std::clamp(z, -reach, reach));
  const std::string style = std::string("bar ") + grade(z);
  svg.rect(std::min(x(0.0), end), top + 12.0, std::abs(end - x(0.0)), 18.0, style);
  const bool right = z >= 0.0;
  const bool room = std::abs(z) < reach - 0.25 * reach;
  const double place = room ? end + (right ? 5.0 : -5.0) : end + (right ? -5.0 : 5.0);
  svg.text(place,
           top + 25.0,
           fixed_text(z, 1),
           right == room ? "start" : "end",
           room ? "value" : "value inside");
}

void draw_parity_legend(Svg& svg, double top) {
  svg.rect(8.0, top, 44.0, 14.0, "band two");
  svg.rect(19.0, top, 22.0, 14.0, "band one");
  svg.line(30.0, top, 30.0, top + 14.0, "measured");
  svg.text(60.0, top + 11.5, "measured, ±1 and ±2 standard errors", "start", "quiet");
  svg.line(318.0, top + 7.0, 346.0, top + 7.0, "whisker");
  svg.circle(332.0, top + 7.0, 5.5, "dot good");
  svg.text(354.0, top + 11.5, "predicted, ±1", "start", "quiet");
}

}  // namespace

const char* grade(double z) {
  const double size = std::abs(z);
  if (size <= 1.0) return "good";
  return size <= 2.0 ? "fair" : "poor";  // NaN is poor
}

std::string parity_chart(const Calibration& calibration, const Fit& fit) {
  constexpr double row = 72.0, head = 26.0;
  const std::vector<FitLine> lines = lines_of(calibration, fit);
  double height = head;
  for (const FitLine& line : lines) height += line.is_curve() ? curve_height : row;
  Svg svg(width, height, "Measured and predicted values, each on its own axis");
  draw_parity_legend(svg, 0.0);
  double top = head;
  for (const FitLine& line : lines) {
    if (line.is_curve()) {
      draw_curve(svg, top, width, line);
    } else {
      draw_parity_row(svg, top, line.measured.front(), line.predicted.front());
    }
    top += line.is_curve() ? curve_height : row;
  }
  return svg.str();
}

std::string residual_chart(const Calibration& calibration, const Fit& fit) {
  constexpr double row = 42.0, foot = 40.0, left = 212.0;
  constexpr double most = 8.0;  // standard errors drawn to scale; beyond, the bar is cut
  const std::vector<FitLine> lines = lines_of(calibration, fit);
  double reach = 3.0;
  for (const FitLine& line : lines) {
    if (std::isfinite(line.z())) reach = std::max(reach, std::abs(line.z()) + 1.0);
  }
  reach = std::min(std::ceil(reach), most);
  const double bottom = row * static_cast<double>(lines.size());
  Svg svg(width, bottom + foot, "Differences between predicted and measured in standard errors");
  const Axis x{-reach, reach, left, width - 10.0};
  svg.rect(x(-2.0), 0.0, x(2.0) - x(-2.0), bottom, "band two");
  svg.rect(x(-1.0), 0.0, x(1.0) - x(-1.0), bottom, "band one");
  double top = 0.0;
  for (const FitLine& line : lines) {
    draw_residual(svg, top, x, line);
    top += row;
  }
  svg.line(x(0.0), 0.0, x(0.0), bottom, "measured");
  svg.line(x.from, bottom, x.to, bottom, "axis");
  for (const auto& [place, words] : ticks(-reach, reach, 6)) {
    svg.line(x(place), bottom, x(place), bottom + 4.0, "axis");
    svg.text(x(place), bottom + 17.0, words, "middle", "tick");
  }
  svg.text(0.5 * (x.from + x.to), bottom + 34.0, "standard errors", "middle", "quiet");
  return svg.str();
}

}  // namespace repose::server
