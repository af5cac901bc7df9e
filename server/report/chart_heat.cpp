#include <algorithm>
#include <array>
#include <cmath>

#include "server/report/chart_lineage.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"
#include "server/report/svg.hpp"

namespace repose::server {

using calibrator::Measurement;

namespace {

std::string signed_text(double z) { return (z > 0.0 ? "+" : "") + fixed_text(z, 1); }

/// "none", then three depths of "low" and of "high".
std::string heat_style(double z) {
  if (!std::isfinite(z)) return "heat unknown";
  constexpr std::array<double, 3> steps{1.0, 2.0, 4.0};
  const auto depth = std::ranges::count_if(steps, [z](double step) { return std::abs(z) > step; });
  if (depth == 0) return "heat none";
  return (z < 0.0 ? "heat low d" : "heat high d") + std::to_string(depth);
}

constexpr double map_width = 480.0, row_height = 25.0, group_height = 28.0, map_head = 46.0;

/// Cut where it does not fit; it stands in full elsewhere on the page.
std::string cut(std::string text, double space) {
  constexpr double letter = 6.8;
  const auto most = static_cast<std::size_t>(std::max(2.0, space / letter));
  if (text.size() <= most) return text;
  std::size_t end = most - 1;
  while (end > 0 && (text[end] & 0xC0) == 0x80) --end;  // not inside a letter of UTF-8
  return text.substr(0, end) + "…";
}

void draw_heat_row(Svg& svg,
                   const Lineage& lineage,
                   std::size_t measurement,
                   double top,
                   double left,
                   double column) {
  const Measurement& what = lineage.front().calibration().measurements[measurement];
  constexpr double indent = 12.0;
  const std::string mark = held_out(what) ? " (held out)" : "";
  const double space = held_out(what) ? 68.0 : 0.0;
  svg.text(indent,
           top + 16.5,
           cut(place_label(lineage.front().calibration(), what), left - indent - space) + mark,
           "start",
           "small");
  for (std::size_t g = 0; g < lineage.size(); ++g) {
    const auto* row = row_of(lineage[g], measurement);
    const double z = row == nullptr ? std::nan("") : row->z;
    const double x = left + column * static_cast<double>(g);
    svg.rect(x + 1.5, top + 1.5, column - 3.0, row_height - 3.0, heat_style(z));
    const bool trusted = row != nullptr && std::abs(row->difference) <= row->tolerance;
    if (trusted) svg.rect(x + 1.5, top + 1.5, column - 3.0, row_height - 3.0, "heat inside");
    svg.text(x + 0.5 * column,
             top + 17.0,
             std::isfinite(z) ? signed_text(z) : "-",
             "middle",
             std::abs(z) > 4.0 ? "heat-text deep" : "heat-text");
  }
}

}  // namespace

std::string model_style(std::size_t generation) {
  constexpr std::size_t styles = 4;
  return "m" + std::to_string(std::min(generation, styles - 1));
}

std::string model_legend(const Lineage& lineage) {
  std::string text = "<p class=\"legend\">";
  for (std::size_t g = 0; g < lineage.size(); ++g) {
    if (g > 0) text += " ";
    text += "<span><i class=\"" + model_style(g) + "\"></i>" + escaped(model_name(lineage[g])) +
            "</span>";
  }
  return text + " <span><i class=\"open\"></i>hollow: held out</span></p>\n";
}

std::string residual_map(const Lineage& lineage) {
  const auto groups = groups_by_observable(lineage.front().calibration());
  const auto models = static_cast<double>(lineage.size());
  const double left = std::max(170.0, map_width - 145.0 * models);
  const double column = (map_width - left) / models;
  double size = map_head;
  for (const auto& group : groups) {
    size += group_height + row_height * static_cast<double>(group.measurements.size());
  }
  Svg svg(map_width, size + 4.0, "Differences in standard errors, by measurement and model");
  for (std::size_t g = 0; g < lineage.size(); ++g) {
    const double middle = left + column * (static_cast<double>(g) + 0.5);
    svg.text(middle, 14.0, cut(model_name(lineage[g]), column), "middle", "label small");
    svg.text(
        middle, 32.0, "rms " + fixed_text(lineage[g].comparison.fitted_z, 2), "middle", "quiet");
  }
  double top = map_head;
  for (const auto& group : groups) {
    svg.text(0.0, top + 17.0, group.name, "start", "label small");
    top += group_height;
    for (const std::size_t m : group.measurements) {
      draw_heat_row(svg, lineage, m, top, left, column);
      top += row_height;
    }
  }
  return svg.str();
}

}  // namespace repose::server
