#include <algorithm>
#include <cmath>
#include <limits>

#include "server/report/axis.hpp"
#include "server/report/chart_lineage.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"
#include "server/report/svg.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::ComparedMeasurement;
using calibrator::Measurement;

namespace {

constexpr double width = 330.0, height = 312.0;  // pixels at full size, as all below
constexpr double left = 52.0, right = width - 10.0, top = 26.0, bottom = height - 42.0;

/// How far a right model may be off, part upon part, SI.
struct Allowed {
  double measurement, simulation, all;
};

Allowed allowed(const ComparedMeasurement& row) {
  const double inner = row.measurement_error;
  return {inner,
          std::hypot(inner, row.simulation_error),
          std::hypot(inner, row.simulation_error, row.tolerance)};
}

/// Room for every measurement with its errors and for both predictions.
Axis range_of(const Lineage& lineage, const MeasurementGroup& group, double factor) {
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
  const auto include = [&](double value) {
    if (!std::isfinite(value)) return;
    lower = std::min(lower, value / factor);
    upper = std::max(upper, value / factor);
  };
  for (const std::size_t m : group.measurements) {
    const double measured = lineage.front().calibration().measurements[m].value;
    for (const Generation* generation : {&lineage.front(), &lineage.back()}) {
      const auto* row = row_of(*generation, m);
      if (row == nullptr) continue;
      include(measured + 1.5 * allowed(*row).all);
      include(measured - 1.5 * allowed(*row).all);
      include(row->predicted);
    }
  }
  const double room = upper > lower ? 0.05 * (upper - lower) : 1.0;
  return {lower - room, upper + room, left, right};
}

void draw_frame(Svg& svg, const Axis& x, const Axis& y, const std::string& title) {
  svg.text(left, 12.0, title, "start", "label");
  for (const auto& [place, words] : ticks(x.lower, x.upper, 4)) {
    svg.line(x(place), top, x(place), bottom, "grid");
    svg.line(left, y(place), right, y(place), "grid");
    svg.text(x(place), bottom + 16.0, words, "middle", "tick");
    svg.text(left - 6.0, y(place) + 4.0, words, "end", "tick");
  }
  svg.line(left, bottom, right, bottom, "axis");
  svg.line(left, top, left, bottom, "axis");
  svg.line(x(x.lower), y(x.lower), x(x.upper), y(x.upper), "measured");
  svg.text(0.5 * (left + right), bottom + 34.0, "measured", "middle", "quiet");
  svg.text(left + 5.0, top + 12.0, "predicted", "start", "quiet");
}

void draw_allowed(
    Svg& svg, const Axis& x, const Axis& y, double measured, const Allowed& parts, double factor) {
  constexpr double half = 5.0;
  const auto bar = [&](double reach, const char* style) {
    const double up = y((measured + reach) / factor), down = y((measured - reach) / factor);
    svg.rect(x(measured / factor) - half, up, 2.0 * half, std::max(1.0, down - up), style);
  };
  bar(parts.all, "part three");
  bar(parts.simulation, "part two");
  bar(parts.measurement, "part one");
}

std::string hint_of(const Calibration& calibration, const ComparedMeasurement& row) {
  const Measurement& measurement = calibration.measurements[row.measurement];
  return place_label(calibration, measurement) + ": measured " +
         with_error(measurement.value, row.measurement_error, measurement.unit) + ", predicted " +
         with_error(row.predicted, row.simulation_error, measurement.unit) + ", z " +
         fixed_text(row.z, 1);
}

std::string panel(const Lineage& lineage, const MeasurementGroup& group) {
  const auto& measurements = lineage.front().calibration().measurements;
  const engine::Unit unit = measurements[group.measurements.front()].unit;
  const Axis x = range_of(lineage, group, unit.factor);
  const Axis y{x.lower, x.upper, bottom, top};
  Svg svg(width, height, group.name + ": predicted against measured");
  draw_frame(svg, x, y, group.name + unit_suffix(unit));
  for (const std::size_t m : group.measurements) {
    const auto* row = row_of(lineage.back(), m);
    if (row == nullptr) continue;
    draw_allowed(svg, x, y, measurements[m].value, allowed(*row), unit.factor);
  }
  const auto draw = [&](std::size_t g, std::size_t m) {
    const auto* row = row_of(lineage[g], m);
    if (row == nullptr || !std::isfinite(row->predicted)) return;
    const bool open = held_out(measurements[m]);
    svg.circle(x(measurements[m].value / unit.factor),
               y(row->predicted / unit.factor),
               g == 0 ? 4.5 : 5.5,
               "model " + model_style(g) + (open ? " hollow" : ""),
               model_name(lineage[g]) + ", " + hint_of(lineage[g].calibration(), *row));
  };
  for (const std::size_t m : group.measurements) {
    draw(0, m);
    if (lineage.size() > 1) draw(lineage.size() - 1, m);
  }
  return svg.str();
}

}  // namespace

std::string parity_panels(const Lineage& lineage) {
  std::string text;
  for (const MeasurementGroup& group : groups_by_observable(lineage.front().calibration())) {
    text += "<div>" + panel(lineage, group) + "</div>\n";
  }
  return text;
}

}  // namespace repose::server
