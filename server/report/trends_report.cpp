#include "server/report/trends_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"
#include "server/report/page.hpp"
#include "server/report/svg.hpp"

namespace repose::server {

namespace {

constexpr double names_width = 150.0, plot_width = 112.0, plot_height = 84.0, gap = 12.0;
constexpr double head_height = 58.0, foot_height = 20.0;  // pixels at full size, as all here

/// One observable: a column of plots with one scale.
struct Column {
  std::string experiment;
  std::string key;  ///< "kettle.bulk_density"
  const engine::ObservableInfo* info;
  double mean = 0.0, deviation = 0.0;  ///< of the reference grain's seeds, in the printed unit
  double lower = 0.0, upper = 1.0;

  [[nodiscard]] double height(double value) const {
    return plot_height * (1.0 - (value - lower) / (upper - lower));
  }
};

std::vector<double> shown(const Readings& readings, const Column& column) {
  const auto found = readings.find(column.key);
  if (found == readings.end()) return {};
  std::vector<double> values = found->second;
  for (double& value : values) value /= column.info->unit.factor;
  return values;
}

void measure_reference(const Trends& trends, Column& column) {
  std::vector<double> seeds = shown(trends.reference, column);
  std::erase_if(seeds, [](double value) { return std::isnan(value); });
  const auto count = static_cast<double>(seeds.size());
  for (const double value : seeds) column.mean += value / count;
  double squares = 0.0;
  for (const double value : seeds) squares += (value - column.mean) * (value - column.mean);
  column.deviation = count > 1.0 ? std::sqrt(squares / (count - 1.0)) : 0.0;
}

void scale(const Trends& trends, Column& column) {
  column.lower = column.mean - 2.0 * column.deviation;
  column.upper = column.mean + 2.0 * column.deviation;
  for (const Readings& readings : trends.readings) {
    for (const double value : shown(readings, column)) {
      if (std::isnan(value)) continue;
      column.lower = std::min(column.lower, value);
      column.upper = std::max(column.upper, value);
    }
  }
  if (!(column.upper > column.lower)) column.upper = column.lower + 1.0;
}

std::vector<Column> columns_of(const Trends& trends) {
  std::vector<Column> columns;
  for (const engine::ExperimentInfo& info : engine::experiment_catalogue()) {
    for (const engine::ObservableInfo& observable : info.observables) {
      Column column{std::string(info.name),
                    std::string(info.name) + "." + std::string(observable.name),
                    &observable};
      measure_reference(trends, column);
      scale(trends, column);
      columns.push_back(std::move(column));
    }
  }
  return columns;
}

std::string spaced(std::string_view name) {
  std::string text(name);
  std::ranges::replace(text, '_', ' ');
  return text;
}

double column_left(std::size_t column) {
  return names_width + static_cast<double>(column) * (plot_width + gap);
}

void draw_head(Svg& svg, const std::vector<Column>& columns) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const double x = column_left(c);
    const std::string_view unit = columns[c].info->unit.symbol;
    svg.text(x, 12.0, spaced(columns[c].experiment), "start", "quiet");
    svg.text(x, 28.0, spaced(columns[c].info->name), "start", "label small");
    svg.text(x, 43.0, unit == "1" ? "" : unit, "start", "quiet");
  }
}

/// A line through the readings; where there was none, a mark at the foot.
void draw_plot(Svg& svg,
               const Column& column,
               const TrendParameter& parameter,
               const std::vector<double>& readings,
               double left,
               double top) {
  const double from = parameter.values.front(), to = parameter.values.back();
  const auto x = [&](double value) { return left + plot_width * (value - from) / (to - from); };
  svg.rect(left, top, plot_width, plot_height, "track");
  const double high = column.height(column.mean + 2.0 * column.deviation);
  const double low = column.height(column.mean - 2.0 * column.deviation);
  svg.rect(left, top + high, plot_width, std::max(1.0, low - high), "band one");
  std::vector<std::pair<double, double>> line;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    if (!std::isnan(readings[k])) {
      line.emplace_back(x(parameter.values[k]), top + column.height(readings[k]));
    }
  }
  svg.polyline(line, "expectation");
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const std::string at = number_text(parameter.values[k], 3) + unit_suffix(parameter.unit);
    const double place = x(parameter.values[k]);
    if (std::isnan(readings[k])) {
      svg.text(place, top + plot_height - 3.0, "×", "middle", "label poor");
      continue;
    }
    svg.circle(place,
               top + column.height(readings[k]),
               3.2,
               "dot interval",
               spaced(column.key) + " " + number_text(readings[k], 4) +
                   unit_suffix(column.info->unit) + " at " + at);
  }
}

void draw_row(Svg& svg,
              const std::vector<Column>& columns,
              const TrendParameter& parameter,
              const Readings& readings,
              double top) {
  const std::size_t point = parameter.name.find('.');
  svg.text(0.0, top + 20.0, spaced(parameter.name.substr(0, point)), "start", "label small");
  svg.text(0.0, top + 37.0, spaced(parameter.name.substr(point + 1)), "start", "quiet");
  svg.text(0.0,
           top + 53.0,
           number_text(parameter.values.front(), 3) + " to " +
               number_text(parameter.values.back(), 3) + unit_suffix(parameter.unit),
           "start",
           "quiet");
  if (!parameter.settings.empty()) {
    svg.text(0.0,
             top + 69.0,
             settings_label({columns[0].experiment, {}, parameter.settings}),
             "start",
             "quiet");
  }
  for (std::size_t c = 0; c < columns.size(); ++c) {
    draw_plot(svg, columns[c], parameter, shown(readings, columns[c]), column_left(c), top);
  }
}

/// The scale of each column, under its last plot.
void draw_foot(Svg& svg, const std::vector<Column>& columns, double top) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    svg.text(column_left(c),
             top + 13.0,
             number_text(columns[c].lower, 3) + " to " + number_text(columns[c].upper, 3),
             "start",
             "tick");
  }
}

}  // namespace

std::string print_trends_report(const Trends& trends, const std::string& command) {
  const std::vector<Column> columns = columns_of(trends);
  const double row_height = plot_height + gap;
  const double rows = row_height * static_cast<double>(trends.parameters.size());
  Svg svg(column_left(columns.size()), head_height + rows + foot_height, "Trends");
  draw_head(svg, columns);
  for (std::size_t p = 0; p < trends.parameters.size(); ++p) {
    draw_row(svg,
             columns,
             trends.parameters[p],
             trends.readings[p],
             head_height + row_height * static_cast<double>(p));
  }
  draw_foot(svg, columns, head_height + rows);
  const std::string missing =
      trends.missing == 0 ? "" : " " + std::to_string(trends.missing) + " runs are missing.";
  return page_head("Trends of the laboratory") + "<header>" +
         element("p", "The virtual laboratory", "kind") +
         element("h1", "Every observable under every parameter") +
         element("p",
                 "The reference grain with one parameter changed, draft fidelity, one seed a "
                 "point. The band is two standard deviations of the reference grain's seeds to "
                 "either side: what stays within it is no trend. A column has one scale, written "
                 "at its foot. × marks a run that gave no reading." +
                     missing) +
         "</header>\n<section class=\"wide\">\n" + svg.str() + "</section>\n<section>\n" +
         "<dl class=\"plain\">\n" + described("command", command) +
         described("engine", engine::version()) + "</dl>\n</section>\n" + std::string(page_foot);
}

}  // namespace repose::server
