#include <algorithm>
#include <string>

#include "server/report/chart.hpp"
#include "server/report/label.hpp"
#include "server/report/svg.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Fit;

/// A triangle of squares: parameter `row` upwards over parameter `column`.
std::string posterior_chart(const Calibration& calibration, const Fit& fit) {
  constexpr double width = 480.0, left = 24.0, gap = 6.0;  // pixels at full size
  const std::size_t count = calibration.free.size();
  const double cell = std::min(150.0, (width - left) / static_cast<double>(count - 1));
  const double top = 20.0 * static_cast<double>(count);
  Svg svg(width,
          top + cell * static_cast<double>(count - 1) + 20.0,
          "Samples of the posterior, every parameter against every other");
  const auto number = [](std::size_t k) { return std::to_string(k + 1); };
  for (std::size_t k = 0; k < count; ++k) {
    svg.text(left,
             20.0 * static_cast<double>(k) + 12.0,
             number(k) + "  " + parameter_label(calibration.free[k].key),
             "start",
             "label small");
  }
  const auto share = [&](std::size_t k, const std::vector<double>& set) {
    return share_of_range(calibration.free[k], set[k]);
  };
  std::vector<double> best;
  for (const calibrator::FittedParameter& fitted : fit.parameters) best.push_back(fitted.value);
  for (std::size_t row = 1; row < count; ++row) {
    for (std::size_t column = 0; column < row; ++column) {
      const double x = left + cell * static_cast<double>(column);
      const double y = top + cell * static_cast<double>(row - 1);
      const double side = cell - gap;
      svg.rect(x, y, side, side, "track");
      for (const std::vector<double>& sample : fit.posterior.samples) {
        svg.dot(x + side * share(column, sample), y + side * (1.0 - share(row, sample)));
      }
      if (best.size() != count) continue;
      svg.diamond(x + side * share(column, best), y + side * (1.0 - share(row, best)), 4.5, "best");
    }
  }
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const double middle = cell * (static_cast<double>(k) + 0.5) - 0.5 * gap;
    svg.text(left + middle,
             top + cell * static_cast<double>(count - 1) + 12.0,
             number(k),
             "middle",
             "tick");
    svg.text(left - 8.0, top + middle + 4.0, number(k + 1), "end", "tick right");
  }
  return svg.str();
}

}  // namespace repose::server
