#include <algorithm>
#include <cmath>

#include "server/report/chart.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"
#include "server/report/svg.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Direction;
using calibrator::Fit;
using calibrator::FittedParameter;
using calibrator::FreeParameter;

namespace {

constexpr double width = 480.0;  // pixels at full size, as all below

std::string in_unit(double value, const engine::Unit& unit) {
  return number_text(value / unit.factor, 3);
}

void draw_interval(Svg& svg, double top, const FreeParameter& free, const FittedParameter& fitted) {
  constexpr double left = 8.0, right = width - 8.0;
  const auto x = [&](double value) { return left + (right - left) * share_of_range(free, value); };
  const double middle = top + 30.0;
  const std::string best = in_unit(fitted.value, free.unit) + unit_suffix(free.unit);
  const std::string interval =
      in_unit(fitted.lower, free.unit) + " to " + in_unit(fitted.upper, free.unit);
  svg.text(left, top + 13.0, parameter_label(free.key), "start", "label");
  svg.text(right,
           top + 13.0,
           fitted.determined ? best + "  (" + interval + ")" : "not determined: " + interval,
           "end",
           fitted.determined ? "value" : "value undetermined");
  svg.rect(left, middle - 5.0, right - left, 10.0, "track");
  svg.rect(x(fitted.lower),
           middle - 5.0,
           std::max(2.0, x(fitted.upper) - x(fitted.lower)),
           10.0,
           fitted.determined ? "interval" : "interval undetermined");
  svg.diamond(x(fitted.value), middle, 7.5, fitted.determined ? "best" : "best undetermined");
  svg.text(left, middle + 21.0, in_unit(free.lower, free.unit), "start", "tick left");
  svg.text(
      right,
      middle + 21.0,
      in_unit(free.upper, free.unit) + (free.scale == calibrator::Scale::log ? " (log scale)" : ""),
      "end",
      "tick right");
}

}  // namespace

double share_of_range(const FreeParameter& free, double value) {
  const double inside = std::clamp(value, free.lower, free.upper);
  if (free.scale == calibrator::Scale::log && free.lower > 0.0) {
    return std::log(inside / free.lower) / std::log(free.upper / free.lower);
  }
  return (inside - free.lower) / (free.upper - free.lower);
}

std::string interval_chart(const Calibration& calibration, const Fit& fit) {
  constexpr double row = 66.0;
  Svg svg(width,
          row * static_cast<double>(fit.parameters.size()),
          "Free parameters within their bounds, best values and 95 % intervals");
  double top = 0.0;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    draw_interval(svg, top, calibration.free.at(i), fit.parameters[i]);
    top += row;
  }
  return svg.str();
}

std::string direction_chart(const Calibration& calibration, const Fit& fit) {
  constexpr double left = 216.0, head = 62.0, row = 34.0, widest = 62.0;
  const double count = static_cast<double>(std::max<std::size_t>(1, fit.directions.size()));
  const double column = std::min(widest, (width - left) / count);
  const double bottom = head + row * static_cast<double>(calibration.free.size());
  Svg svg(width, bottom + 8.0, "Directions in parameter space and how well the data fix them");
  svg.text(0.0, 14.0, "what is left of the prior width", "start", "quiet left");
  for (std::size_t i = 0; i < calibration.free.size(); ++i) {
    const double middle = head + row * (static_cast<double>(i) + 0.5);
    const std::string label = parameter_label(calibration.free[i].key);
    svg.text(0.0, middle + 4.0, label, "start", "label small");
    svg.line(left, middle, left + column * count, middle, "grid");
  }
  double x = left + 0.5 * column;
  for (const Direction& direction : fit.directions) {
    const double kept = std::clamp(direction.posterior_to_prior, 0.0, 1.0);
    svg.rect(x - 0.4 * column, 20.0, 0.8 * column, 10.0, "track");
    svg.rect(x - 0.4 * column,
             20.0,
             0.8 * column * kept,
             10.0,
             direction.learnt ? "interval" : "interval undetermined");
    svg.text(x, 14.0, fixed_text(100.0 * kept, 0) + " %", "middle", "tick");
    svg.text(x, 46.0, direction.learnt ? "learnt" : "open", "middle", "tick");
    for (std::size_t i = 0; i < direction.components.size(); ++i) {
      const double size = direction.components[i];
      const double middle = head + row * (static_cast<double>(i) + 0.5);
      if (std::abs(size) < 0.05) continue;
      svg.circle(x,
                 middle,
                 14.0 * std::sqrt(std::min(1.0, std::abs(size))),
                 std::string(size > 0.0 ? "up" : "down") + (direction.learnt ? "" : " faint"),
                 fixed_text(size, 2));
      svg.text(x, middle + 4.5, size > 0.0 ? "+" : "−", "middle", "sign");
    }
    x += column;
  }
  return svg.str();
}

}  // namespace repose::server
