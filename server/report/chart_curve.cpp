#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/catalogue.hpp"
#include "server/report/chart.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"

namespace repose::server {

using calibrator::Measurement;
using calibrator::Prediction;

namespace {

struct Range {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -std::numeric_limits<double>::infinity();

  void take(double value) {
    if (!std::isfinite(value)) return;
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  }
  /// From 0 to 1, a tenth kept free at either end.
  [[nodiscard]] double share(double value) const {
    return upper > lower ? 0.1 + 0.8 * (value - lower) / (upper - lower) : 0.5;
  }
};

engine::Unit setting_unit(const std::string& experiment, const std::string& setting) {
  const engine::ExperimentInfo* info = engine::find_experiment(experiment);
  if (info == nullptr) return engine::unit::one;
  const auto found = std::ranges::find(info->settings, setting, &engine::FieldInfo::name);
  return found != info->settings.end() ? found->unit : engine::unit::one;
}

}  // namespace

void draw_curve(Svg& svg, double top, double width, const FitLine& line) {
  constexpr double left = 52.0, right_margin = 8.0, head = 24.0, foot = 40.0;
  const double bottom = top + curve_height - foot;
  const std::string along = calibrator::setting_along(line.measured);
  const Measurement& first = line.measured.front();
  const engine::Unit abscissa = setting_unit(first.experiment.name, along);
  const double factor = first.unit.factor;
  const auto setting = [&](const Measurement& m) {
    const auto found = m.experiment.settings.find(along);
    return found == m.experiment.settings.end() ? 0.0 : found->second / abscissa.factor;
  };
  Range across, up;
  for (std::size_t i = 0; i < line.measured.size(); ++i) {
    const Measurement& m = line.measured[i];
    across.take(setting(m));
    for (const double side : {-1.0, 1.0}) up.take((m.value + side * m.standard_error) / factor);
    up.take(line.predicted[i].predicted / factor);
  }
  const auto x = [&](double value) {
    return left + (width - right_margin - left) * across.share(value);
  };
  const auto y = [&](double value) { return bottom - (bottom - top - head) * up.share(value); };
  svg.text(8.0, top + 12.0, line_label(line.measured), "start", "label");
  svg.text(width - 8.0, top + 12.0, unit_suffix(first.unit), "end", "quiet");
  svg.line(left, bottom, width - right_margin, bottom, "axis");
  for (const auto& [place, words] : ticks(across.lower, across.upper, 5)) {
    svg.line(x(place), bottom, x(place), bottom + 4.0, "axis");
    svg.text(x(place), bottom + 16.0, words, "middle", "tick");
  }
  for (const auto& [place, words] : ticks(up.lower, up.upper, 4)) {
    svg.line(left, y(place), width - right_margin, y(place), "grid");
    svg.text(left - 6.0, y(place) + 4.0, words, "end", "tick right");
  }
  svg.text(0.5 * (left + width), bottom + 31.0, along + unit_suffix(abscissa), "middle", "quiet");
  std::vector<std::pair<double, double>> predicted;
  for (std::size_t i = 0; i < line.measured.size(); ++i) {
    const Measurement& m = line.measured[i];
    const double here = x(setting(m));
    svg.line(here,
             y((m.value - m.standard_error) / factor),
             here,
             y((m.value + m.standard_error) / factor),
             "measured");
    svg.line(here - 5.0, y(m.value / factor), here + 5.0, y(m.value / factor), "measured");
    if (std::isfinite(line.predicted[i].predicted)) {
      predicted.emplace_back(here, y(line.predicted[i].predicted / factor));
    }
  }
  svg.polyline(predicted, "expectation");
  for (std::size_t i = 0; i < line.measured.size(); ++i) {
    const Prediction& p = line.predicted[i];
    if (!std::isfinite(p.predicted)) continue;
    svg.circle(x(setting(line.measured[i])),
               y(p.predicted / factor),
               5.0,
               std::string("dot ") + grade(p.z),
               "predicted " + with_error(p.predicted, p.standard_error, first.unit));
  }
}

}  // namespace repose::server
