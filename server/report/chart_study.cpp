#include "server/report/chart_study.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "server/report/number_text.hpp"
#include "server/report/study_words.hpp"
#include "server/report/svg.hpp"
#include "server/studies/study_findings.hpp"

namespace repose::server {

namespace {

constexpr double width = 480.0, right = width - 12.0;  // pixels at full size, as all below
constexpr double left = 118.0;                         // where rows begin, after their names
constexpr double row_height = 21.0, head = 26.0, foot = 40.0;

/// Values along x; grows with what it is shown.
struct Axis {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -std::numeric_limits<double>::infinity();
  double from = left, to = right;

  void include(double value, double reach = 0.0) {
    if (!std::isfinite(value)) return;
    const double around = std::isfinite(reach) ? reach : 0.0;
    lower = std::min(lower, value - around);
    upper = std::max(upper, value + around);
  }
  /// Some room at both ends.
  void widen() {
    const double room = upper > lower ? 0.06 * (upper - lower) : 1.0;
    lower -= room;
    upper += room;
  }
  double operator()(double value) const {
    return from + (to - from) * (value - lower) / (upper - lower);
  }
};

void draw_axis(Svg& svg, const Axis& x, double top, double bottom, const std::string& title) {
  for (const auto& [place, words] : ticks(x.lower, x.upper, 6)) {
    svg.line(x(place), top, x(place), bottom, "grid");
    svg.text(x(place), bottom + 17.0, words, "middle", "tick");
  }
  svg.line(x.from, bottom, x.to, bottom, "axis");
  svg.text(0.5 * (x.from + x.to), bottom + 34.0, title, "middle", "quiet");
}

/// The paper's marks are diamonds, ours are dots.
void draw_legend(Svg& svg) {
  svg.diamond(left + 6.0, 10.0, 5.5, "best undetermined");
  svg.text(left + 17.0, 14.0, "paper", "start", "tick left");
  svg.circle(left + 76.0, 10.0, 5.0, "dot interval");
  svg.text(left + 86.0, 14.0, "here", "start", "tick left");
}

void draw_whisker(Svg& svg, const Axis& x, double y, double value, double reach) {
  if (std::isfinite(value) && reach > 0.0)
    svg.line(x(value - reach), y, x(value + reach), y, "whisker");
}

void draw_ours(
    Svg& svg, const Axis& x, double y, double value, double reach, const std::string& hint) {
  draw_whisker(svg, x, y, value, reach);
  if (std::isfinite(value)) svg.circle(x(value), y, 5.0, "dot interval", hint);
}

void draw_papers(Svg& svg, const Axis& x, double y, double value, double reach) {
  draw_whisker(svg, x, y, value, reach);
  if (std::isfinite(value)) svg.diamond(x(value), y, 5.5, "best undetermined");
}

struct Row {
  std::string name;
  std::string hint;
  double paper = 0.0, paper_reach = 0.0;
  double ours = 0.0, ours_reach = 0.0;
};

std::string rows_chart(const std::vector<Row>& rows,
                       Axis x,
                       const std::string& title,
                       const std::string& axis) {
  for (const Row& row : rows) {
    x.include(row.paper, row.paper_reach);
    x.include(row.ours, row.ours_reach);
  }
  x.widen();
  const double bottom = head + row_height * static_cast<double>(rows.size());
  Svg svg(width, bottom + foot, title);
  draw_axis(svg, x, head - 4.0, bottom, axis);
  if (x.lower < 0.0 && x.upper > 0.0) svg.line(x(0.0), head - 4.0, x(0.0), bottom, "measured");
  draw_legend(svg);
  double y = head + 0.5 * row_height;
  for (const Row& row : rows) {
    svg.text(0.0, y + 4.0, row.name, "start", "label small");
    draw_papers(svg, x, y - 4.0, row.paper, row.paper_reach);
    draw_ours(svg, x, y + 4.0, row.ours, row.ours_reach, row.hint);
    y += row_height;
  }
  return svg.str();
}

double printed_error(const PublishedNumber& number, const StudyExperiment& what) {
  return number.deviation / std::sqrt(what.replicates);
}

}  // namespace

std::string agreement_chart(const StudyResult& result, const StudyExperiment& what) {
  constexpr double bottom = 300.0, begin = 52.0;
  Axis both;
  for (const StudyRun& run : result.study->runs) {
    const auto printed = run.printed.find(what.experiment);
    if (printed == run.printed.end()) continue;
    both.include(printed->second.mean);
    both.include(result.sample(run.run, what.experiment).mean());
  }
  both.include(what.target);
  both.widen();
  Axis x = both, y = both;
  x.from = begin;
  y.from = bottom;
  y.to = 8.0;
  Svg svg(width, bottom + foot, "Ours against the paper's, " + observable_text(what));
  draw_axis(svg, x, y.to, bottom, "paper, " + what.unit);
  for (const auto& [place, words] : ticks(y.lower, y.upper, 6)) {
    svg.line(x.from, y(place), x.to, y(place), "grid");
    svg.text(x.from - 6.0, y(place) + 4.0, words, "end", "tick right");
  }
  svg.line(x(both.lower), y(both.lower), x(both.upper), y(both.upper), "measured");
  svg.line(x(what.target), y.to, x(what.target), bottom, "expected");
  svg.line(x.from, y(what.target), x.to, y(what.target), "expected");
  for (const StudyRun& run : result.study->runs) {
    const auto printed = run.printed.find(what.experiment);
    const double ours = result.sample(run.run, what.experiment).mean();
    if (printed == run.printed.end() || std::isnan(ours)) continue;
    const bool best = run.run == result.study->best, base = run.run == result.study->base;
    svg.circle(x(printed->second.mean),
               y(ours),
               5.0,
               best || base ? "dot poor" : "dot interval",
               run.run + ": paper " + published_text(printed->second) + ", here " +
                   sample_text(result.sample(run.run, what.experiment)));
    if (best || base) {
      svg.text(x(printed->second.mean) + 8.0, y(ours) + 4.0, run.run, "start", "tick left");
    }
  }
  return svg.str();
}

std::string change_chart(const StudyResult& result,
                         const StudyTable& table,
                         const StudyExperiment& what) {
  const PublishedStudy& study = *result.study;
  const Sample& base = result.sample(study.base, what.experiment);
  const PublishedNumber& printed_base = study.run(study.base).printed.at(what.experiment);
  std::vector<Row> rows;
  std::set<std::string> seen{study.base};
  for (const StudyGroup& group : table.groups) {
    for (const std::string& run : group.runs) {
      const auto& printed = study.run(run).printed;
      const auto paper = printed.find(what.experiment);
      if (paper == printed.end() || !seen.insert(run).second) continue;
      const Trend change = trend(result, run, what);
      const double ours = result.sample(run, what.experiment).error();
      rows.push_back(
          {run,
           run + ", " + difference_text(study, run) + ": paper " + signed_text(change.paper, 1) +
               ", here " + signed_text(change.ours, 1),
           change.paper,
           2.0 * std::hypot(printed_error(paper->second, what), printed_error(printed_base, what)),
           change.ours,
           2.0 * std::hypot(ours, base.error())});
    }
  }
  Axis x;
  x.include(0.0);
  return rows_chart(rows,
                    x,
                    table.table + ": changes against the base, " + observable_text(what),
                    "change against " + study.base + ", " + what.unit);
}

std::string variant_chart(const StudyResult& result, const StudyExperiment& what) {
  const PublishedStudy& study = *result.study;
  const double ours = result.sample(study.base, what.experiment).mean();
  const double paper = study.run(study.base).printed.at(what.experiment).mean;
  std::vector<const StudyVariant*> shown;
  Axis x;
  x.include(ours);
  x.include(paper);
  for (const StudyVariant& variant : study.variants) {
    const auto explained = explain(result, variant.variant, what);
    if (!explained) continue;
    shown.push_back(&variant);
    x.include(explained->sample.mean(), 2.0 * explained->sample.error());
  }
  x.widen();
  const double bottom = head + row_height * static_cast<double>(shown.size());
  Svg svg(width, bottom + foot, "Variants of the base, " + observable_text(what));
  draw_axis(svg, x, head - 4.0, bottom, observable_text(what) + ", " + what.unit);
  svg.line(x(paper), head - 4.0, x(paper), bottom, "measured");
  svg.line(x(ours), head - 4.0, x(ours), bottom, "expected");
  svg.text(x(paper), 14.0, "paper", "middle", "tick");
  svg.text(x(ours), 14.0, "base here", "middle", "tick");
  double y = head + 0.5 * row_height;
  for (const StudyVariant* variant : shown) {
    const auto explained = explain(result, variant->variant, what);
    svg.text(0.0, y + 4.0, variant->variant, "start", "label small");
    draw_ours(svg,
              x,
              y,
              explained->sample.mean(),
              2.0 * explained->sample.error(),
              variant->meaning + ": " + sample_text(explained->sample));
    y += row_height;
  }
  return svg.str();
}

std::string cost_chart(const StudyResult& result, const StudyExperiment& what) {
  std::vector<Row> rows;
  for (const StudyRun& run : result.study->computing_hours) {
    const CostRatio ratio = cost_ratio(result, run.run, what.experiment);
    rows.push_back({run.run,
                    "paper " + fixed_text(ratio.paper, 2) + ", here " + fixed_text(ratio.ours, 2),
                    ratio.paper,
                    0.0,
                    ratio.ours,
                    0.0});
  }
  Axis x;
  x.include(0.0);
  return rows_chart(rows,
                    x,
                    "Computing time, " + what.experiment,
                    what.experiment + ": computing for a simulated second, base = 1");
}

}  // namespace repose::server
