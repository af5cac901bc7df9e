#include <algorithm>
#include <cmath>
#include <string>

#include "server/report/chart_lineage.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"
#include "server/report/svg.hpp"

namespace repose::server {

using calibrator::FreeParameter;

namespace {

constexpr double width = 480.0, left = 8.0;  // pixels at full size, as all below

/// Where a value lies between its bounds, 0 to 1, by the parameter's own scale.
double share(const FreeParameter& free, double value) {
  const double inside = std::clamp(value, free.lower, free.upper);
  if (free.scale == calibrator::Scale::log && free.lower > 0.0) {
    return std::log(inside / free.lower) / std::log(free.upper / free.lower);
  }
  return (inside - free.lower) / (free.upper - free.lower);
}

void draw_fitted(Svg& svg,
                 double middle,
                 const FreeParameter& free,
                 const calibrator::FittedParameter& fitted,
                 std::size_t g) {
  const auto x = [&](double value) { return left + (width - 2.0 * left) * share(free, value); };
  const std::string style = "model " + model_style(g);
  svg.rect(x(fitted.lower),
           middle - 2.0,
           std::max(2.0, x(fitted.upper) - x(fitted.lower)),
           4.0,
           style + " faint");
  svg.diamond(x(fitted.value), middle, 7.0, style);
}

std::string shown(double value, const FreeParameter& free) {
  return number_text(value / free.unit.factor, 3);
}

/// The parameter as a model has fitted it; null where it is not free there.
const calibrator::FittedParameter* fitted_of(const Generation& generation,
                                             const engine::ParameterKey& key) {
  const auto& fitted = generation.fit().parameters;
  const auto found = std::ranges::find(fitted, key, &calibrator::FittedParameter::key);
  return found == fitted.end() ? nullptr : &*found;
}

constexpr double shift_row = 72.0;

void draw_shift(Svg& svg, const Lineage& lineage, std::size_t index, double top) {
  const Generation& last = lineage.back();
  const FreeParameter& free = last.calibration().free[index];
  const auto& now = last.fit().parameters[index];
  const auto* before = lineage.size() > 1 ? fitted_of(lineage.front(), free.key) : nullptr;
  std::string words = shown(now.value, free);
  if (before != nullptr) {
    words = shown(before->value, free) + " → " + words;
  }
  words += unit_suffix(free.unit);
  if (lineage.size() > 1 && before == nullptr) words = "new: " + words;
  if (now.lower_at_bound || now.upper_at_bound) words += ", interval ends at its bound";
  svg.text(left, top + 13.0, parameter_label(free.key), "start", "label");
  svg.text(left, top + 29.0, words, "start", "small");
  const double middle = top + 44.0;
  svg.rect(left, middle - 6.0, width - 2.0 * left, 12.0, "track");
  if (before != nullptr) draw_fitted(svg, middle - 3.0, free, *before, 0);
  draw_fitted(svg, before != nullptr ? middle + 3.0 : middle, free, now, lineage.size() - 1);
  svg.text(left, middle + 20.0, shown(free.lower, free), "start", "tick left");
  svg.text(width - left, middle + 20.0, shown(free.upper, free), "end", "tick right");
}

}  // namespace

std::string shift_chart(const Lineage& lineage) {
  const auto count = lineage.back().fit().parameters.size();
  Svg svg(width,
          shift_row * static_cast<double>(count),
          "Free parameters within their bounds, under the first model and under the last");
  for (std::size_t i = 0; i < count; ++i) {
    draw_shift(svg, lineage, i, shift_row * static_cast<double>(i));
  }
  return svg.str();
}

}  // namespace repose::server
