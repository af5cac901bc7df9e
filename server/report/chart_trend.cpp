#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/catalogue.hpp"
#include "server/report/axis.hpp"
#include "server/report/chart_lineage.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"
#include "server/report/svg.hpp"

namespace repose::server {

using calibrator::Measurement;

namespace {

constexpr double width = 330.0, height = 246.0;
constexpr double left = 40.0, right = width - 10.0, top = 26.0, bottom = height - 42.0;

const engine::FieldInfo* setting_of_group(const Measurement& measurement,
                                          const std::string& setting) {
  const auto* info = engine::find_experiment(measurement.experiment.name);
  if (info == nullptr) return nullptr;
  const auto found = std::ranges::find(info->settings, setting, &engine::FieldInfo::name);
  return found == info->settings.end() ? nullptr : &*found;
}

/// One place along the condition and the z of every model there.
struct TrendPoint {
  double at;
  bool open;
  std::vector<double> z;
};

std::vector<TrendPoint> points_of(const Lineage& lineage,
                                  const std::string& observable,
                                  const std::string& setting,
                                  double factor) {
  std::vector<TrendPoint> points;
  const auto& measurements = lineage.front().calibration().measurements;
  for (std::size_t m = 0; m < measurements.size(); ++m) {
    const Measurement& what = measurements[m];
    if (what.experiment.name + "." + what.observable != observable) continue;
    TrendPoint point{calibrator::setting_of(what, setting) / factor, held_out(what), {}};
    for (const Generation& generation : lineage) {
      const auto* row = row_of(generation, m);
      point.z.push_back(row == nullptr ? std::nan("") : row->z);
    }
    points.push_back(std::move(point));
  }
  std::ranges::sort(points, {}, &TrendPoint::at);
  return points;
}

Axis condition_axis(const std::vector<TrendPoint>& points) {
  const double least = points.front().at, most = points.back().at;
  if (least > 0.0 && most / least > 3.0) {
    const double room = std::pow(most / least, 0.06);
    return {least / room, most * room, left, right, true};
  }
  const double room = 0.06 * (most - least);
  return {least - room, most + room, left, right};
}

/// Along a logarithmic axis the measured places themselves, as far as their numbers have room.
std::vector<Tick> condition_ticks(const Axis& x, const std::vector<TrendPoint>& points) {
  if (!x.logarithmic) return ticks(x.lower, x.upper, 5);
  std::vector<Tick> places;
  double last = -1e9;
  for (const TrendPoint& point : points) {
    constexpr double room = 34.0;
    if (x(point.at) - last < room) continue;
    last = x(point.at);
    places.push_back({point.at, number_text(point.at, 3)});
  }
  return places;
}

void draw_model(Svg& svg,
                const Axis& x,
                const Axis& y,
                const std::vector<TrendPoint>& points,
                const Lineage& lineage,
                std::size_t g) {
  std::vector<std::pair<double, double>> line;
  const auto height_of = [&](double z) { return y(std::clamp(z, y.lower, y.upper)); };
  for (const TrendPoint& point : points) {
    if (std::isfinite(point.z[g])) line.emplace_back(x(point.at), height_of(point.z[g]));
  }
  svg.polyline(line, "model-line " + model_style(g));
  for (const TrendPoint& point : points) {
    if (!std::isfinite(point.z[g])) continue;
    svg.circle(x(point.at),
               height_of(point.z[g]),
               4.5,
               "model " + model_style(g) + (point.open ? " hollow" : ""),
               model_name(lineage[g]) + ": " + fixed_text(point.z[g], 1));
  }
}

std::string panel(const Lineage& lineage, const calibrator::ResidualTrend& trend) {
  const auto& measurements = lineage.front().calibration().measurements;
  const auto first = std::ranges::find_if(measurements, [&](const Measurement& what) {
    return what.experiment.name + "." + what.observable == trend.observable;
  });
  const auto* field = setting_of_group(*first, trend.setting);
  const engine::Unit unit = field != nullptr ? field->unit : engine::Unit{};
  const auto points = points_of(lineage, trend.observable, trend.setting, unit.factor);
  double reach = 3.0;
  for (const TrendPoint& point : points) {
    for (const double z : {point.z.front(), point.z.back()}) {
      if (std::isfinite(z)) reach = std::max(reach, std::abs(z) * 1.08);
    }
  }
  constexpr double most = 12.0;  // standard errors drawn to scale
  reach = std::min(reach, most);
  const Axis x = condition_axis(points), y{-reach, reach, bottom, top};
  Svg svg(width, height, trend.observable + " along " + trend.setting);
  svg.text(left, 12.0, measurement_label(*first), "start", "label");
  svg.rect(left, y(2.0), right - left, y(-2.0) - y(2.0), "band two");
  svg.rect(left, y(1.0), right - left, y(-1.0) - y(1.0), "band one");
  for (const auto& [place, words] : ticks(-reach, reach, 6)) {
    svg.text(left - 6.0, y(place) + 4.0, words, "end", "tick");
  }
  svg.line(left, y(0.0), right, y(0.0), "measured");
  for (const auto& [place, words] : condition_ticks(x, points)) {
    svg.line(x(place), bottom, x(place), bottom + 4.0, "axis");
    svg.text(x(place), bottom + 16.0, words, "middle", "tick");
  }
  svg.line(left, bottom, right, bottom, "axis");
  std::string words = trend.setting;
  std::ranges::replace(words, '_', ' ');
  svg.text(0.5 * (left + right),
           bottom + 34.0,
           words + (unit.symbol == "1" ? "" : "," + unit_suffix(unit)) +
               (x.logarithmic ? " (logarithmic)" : ""),
           "middle",
           "quiet");
  draw_model(svg, x, y, points, lineage, 0);
  if (lineage.size() > 1) draw_model(svg, x, y, points, lineage, lineage.size() - 1);
  return svg.str();
}

}  // namespace

std::string trend_panels(const Lineage& lineage) {
  std::string text;
  for (const calibrator::ResidualTrend& trend : lineage.front().comparison.trends) {
    text += "<div>" + panel(lineage, trend) + "</div>\n";
  }
  return text;
}

}  // namespace repose::server
