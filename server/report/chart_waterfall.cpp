#include <algorithm>
#include <cmath>
#include <limits>

#include "server/report/axis.hpp"
#include "server/report/chart_lineage.hpp"
#include "server/report/number_text.hpp"
#include "server/report/svg.hpp"

namespace repose::server {

namespace {

constexpr double width = 480.0, left = 8.0, right = width - 124.0;  // pixels at full size

/// Root mean square of the group's z with that role; NaN where there is none.
double rms(const Generation& generation, const MeasurementGroup& group, calibrator::Role role) {
  double sum = 0.0;
  int count = 0;
  for (const std::size_t m : group.measurements) {
    const auto* row = row_of(generation, m);
    if (generation.calibration().measurements[m].role != role || row == nullptr) continue;
    if (!std::isfinite(row->z)) continue;
    sum += row->z * row->z;
    ++count;
  }
  return count == 0 ? std::numeric_limits<double>::quiet_NaN() : std::sqrt(sum / count);
}

/// "1.13; held out 2.15", of those that there are.
std::string value_text(double fitted, double held_out) {
  std::string text = std::isfinite(fitted) ? fixed_text(fitted, 2) : "";
  if (!std::isfinite(held_out)) return text;
  return text + (text.empty() ? "" : "; ") + "held out " + fixed_text(held_out, 2);
}

constexpr double bar = 15.0, title = 22.0, gap = 10.0, head = 22.0, foot = 40.0;

void draw_group(
    Svg& svg, const Axis& x, const Lineage& lineage, const MeasurementGroup& group, double top) {
  svg.text(left, top + 14.0, group.name, "start", "label");
  double y = top + title;
  for (std::size_t g = 0; g < lineage.size(); ++g) {
    const double fitted = rms(lineage[g], group, calibrator::Role::fit);
    const double open = rms(lineage[g], group, calibrator::Role::held_out);
    double end = x(0.0);
    if (std::isfinite(fitted)) {
      end = x(std::min(fitted, x.upper));
      svg.rect(x(0.0), y + 1.5, std::max(1.0, end - x(0.0)), bar - 3.0, "model " + model_style(g));
    }
    if (std::isfinite(open)) {
      const double at = x(std::min(open, x.upper));
      svg.circle(at,
                 y + 0.5 * bar,
                 5.0,
                 "model " + model_style(g) + " hollow aside",
                 "held out: " + fixed_text(open, 2));
      end = std::max(end, at + 5.0);
    }
    svg.text(end + 6.0, y + 11.5, value_text(fitted, open), "start", "tick left");
    y += bar;
  }
}

}  // namespace

std::string waterfall_chart(const Lineage& lineage) {
  const auto groups = groups_by_experiment(lineage.front().calibration());
  double most = 1.5;
  for (const Generation& generation : lineage) {
    for (const auto& group : groups) {
      for (const auto role : {calibrator::Role::fit, calibrator::Role::held_out}) {
        const double value = rms(generation, group, role);
        if (std::isfinite(value)) most = std::max(most, 1.05 * value);
      }
    }
  }
  const double each = title + bar * static_cast<double>(lineage.size()) + gap;
  const double bottom = head + each * static_cast<double>(groups.size());
  Svg svg(width, bottom + foot, "Root mean square difference of every model, by experiment");
  const Axis x{0.0, most, left, right};
  for (const auto& [place, words] : ticks(0.0, most, 6)) {
    svg.line(x(place), head, x(place), bottom, "grid");
    svg.text(x(place), bottom + 16.0, words, "middle", "tick");
  }
  double top = head;
  for (const auto& group : groups) {
    draw_group(svg, x, lineage, group, top);
    top += each;
  }
  svg.line(x(1.0), head - 4.0, x(1.0), bottom, "floor");
  svg.text(x(1.0), head - 9.0, "noise floor", "middle", "tick");
  svg.line(left, bottom, right, bottom, "axis");
  svg.text(0.5 * (left + right),
           bottom + 34.0,
           "root mean square difference, standard errors",
           "middle",
           "quiet");
  return svg.str();
}

}  // namespace repose::server
