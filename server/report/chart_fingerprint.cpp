#include <algorithm>
#include <cmath>
#include <vector>

#include "server/report/axis.hpp"
#include "server/report/chart_lineage.hpp"
#include "server/report/diagnosis_words.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"
#include "server/report/svg.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Diagnosis;
using calibrator::EffectFinding;
using calibrator::Measurement;

namespace {

constexpr double width = 330.0, row_height = 21.0, group_height = 22.0;  // pixels at full size
constexpr double head = 44.0, foot = 40.0, left = 118.0, right = width - 8.0;

/// What an effect does to one fitted measurement, and what the model without it lacks there.
struct Print {
  std::size_t measurement;
  double raw;      ///< at its strength, in standard errors
  double left;     ///< of that, what the free parameters cannot imitate
  double missing;  ///< measured less predicted, in standard errors
};

double deviation(const calibrator::ComparedMeasurement& row) {
  return std::hypot(row.measurement_error, row.tolerance, row.simulation_error);
}

std::vector<Print> prints_of(const Generation& generation,
                             const EffectFinding& finding,
                             double strength) {
  std::vector<Print> prints;
  const auto& measurements = generation.calibration().measurements;
  for (std::size_t m = 0; m < measurements.size(); ++m) {
    const auto* row = row_of(generation, m);
    if (measurements[m].role != calibrator::Role::fit || row == nullptr) continue;
    if (m >= finding.change.size() || m >= finding.trace.size()) continue;
    prints.push_back(
        {m, strength * finding.change[m] / deviation(*row), strength * finding.trace[m], -row->z});
  }
  return prints;
}

double reach_of(const std::vector<Print>& prints) {
  double reach = 2.0;
  for (const Print& print : prints) {
    for (const double value : {print.raw, print.left, print.missing}) {
      if (std::isfinite(value)) reach = std::max(reach, 1.05 * std::abs(value));
    }
  }
  constexpr double most = 15.0;  // standard errors drawn to scale
  return std::min(reach, most);
}

void draw_bar(Svg& svg, const Axis& x, double value, double top, double size, const char* style) {
  if (!std::isfinite(value)) return;
  const double end = x(std::clamp(value, x.lower, x.upper));
  svg.rect(std::min(x(0.0), end), top, std::abs(end - x(0.0)), size, style);
}

void draw_print(
    Svg& svg, const Axis& x, const Calibration& calibration, const Print& print, double top) {
  const Measurement& measurement = calibration.measurements[print.measurement];
  svg.text(10.0, top + 14.5, place_label(calibration, measurement), "start", "small");
  draw_bar(svg, x, print.raw, top + 3.0, row_height - 6.0, "raw");
  draw_bar(svg, x, print.left, top + 6.5, row_height - 13.0, "projected");
  if (!std::isfinite(print.missing)) return;
  svg.circle(x(std::clamp(print.missing, x.lower, x.upper)),
             top + 0.5 * row_height,
             4.5,
             "missing",
             "missing " + fixed_text(print.missing, 1) + ", effect " + fixed_text(print.raw, 1) +
                 ", not imitated " + fixed_text(print.left, 1));
}

std::string panel(const Generation& generation, std::size_t effect, double strength) {
  const EffectFinding& finding = generation.diagnosis->effects[effect];
  const auto& measurements = generation.calibration().measurements;
  const std::vector<Print> prints = prints_of(generation, finding, strength);
  const double reach = reach_of(prints);
  double bottom = head + row_height * static_cast<double>(prints.size());
  std::string group;
  for (const Print& print : prints) {
    const std::string name = measurement_label(measurements[print.measurement]);
    if (name != group) bottom += group_height;
    group = name;
  }
  Svg svg(width, bottom + foot, "Fingerprint of " + finding.suspect.title);
  const Axis x{-reach, reach, left, right};
  svg.text(0.0, 13.0, finding.suspect.title, "start", "label");
  const std::string own = strength_text(finding, generation.diagnosis->parameters, strength);
  svg.text(0.0, 30.0, own.empty() ? "" : "at " + own, "start", "quiet left");
  svg.line(x(0.0), head - 4.0, x(0.0), bottom, "measured");
  double top = head;
  group.clear();
  for (const Print& print : prints) {
    const std::string name = measurement_label(measurements[print.measurement]);
    if (name != group) {
      svg.text(0.0, top + 15.0, name, "start", "label small");
      top += group_height;
    }
    group = name;
    draw_print(svg, x, generation.calibration(), print, top);
    top += row_height;
  }
  svg.line(left, bottom, right, bottom, "axis");
  for (const auto& [place, words] : ticks(-reach, reach, 5)) {
    svg.line(x(place), bottom, x(place), bottom + 4.0, "axis");
    svg.text(x(place), bottom + 16.0, words, "middle", "tick");
  }
  svg.text(0.5 * (left + right), bottom + 34.0, "standard errors", "middle", "quiet");
  return svg.str();
}

}  // namespace

std::string fingerprint_panels(const Generation& generation) {
  constexpr std::size_t most = 3;
  std::string text;
  std::size_t drawn = 0;
  for (const calibrator::Refit& refit : generation.diagnosis->refits) {
    if (refit.effects.size() != 1 || drawn == most) continue;
    ++drawn;
    text +=
        "<div>" + panel(generation, refit.effects.front(), refit.strengths.front()) + "</div>\n";
  }
  return text;
}

}  // namespace repose::server
