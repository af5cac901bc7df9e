#include "server/report/report.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "server/report/chart.hpp"
#include "server/report/fit_line.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"
#include "server/report/page.hpp"
#include "server/report/svg.hpp"
#include "server/report/words.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Fit;
using calibrator::FittedParameter;
using calibrator::Measurement;

namespace {

std::string_view style_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::hit:
      return "verdict hit";
    case Verdict::met:
      return "verdict met";
    case Verdict::missed:
      return "verdict missed";
    case Verdict::unfinished:
      break;
  }
  return "verdict unfinished";
}

std::string fidelity_text(const Calibration& calibration) {
  const auto name = [](engine::Fidelity fidelity) {
    return std::string(engine::fidelity_names[static_cast<std::size_t>(fidelity)]);
  };
  const auto& budget = calibration.budget;
  if (budget.fidelity == budget.confirm_fidelity) return name(budget.fidelity);
  return name(budget.fidelity) + ", then " + name(budget.confirm_fidelity);
}

std::string verdict_section(const Calibration& calibration, const Fit& fit) {
  std::string text = "<div class=\"" + std::string(style_of(verdict(calibration, fit))) + "\">\n";
  text += element("p", headline(calibration, fit)) + "\n<ul>\n";
  for (const std::string& sentence : learnt_sentences(calibration, fit)) {
    text += element("li", sentence) + "\n";
  }
  text +=
      "</ul>\n" + element("p", stop_sentence(fit.stop), "quiet-text") + "\n<dl class=\"facts\">\n";
  const auto fact = [&](std::string_view term, std::string_view what) {
    text += "<div>" + described(term, what) + "</div>";
  };
  fact("misfit (sum of z²)", number_text(fit.misfit, 3));
  fact("fitted measurements",
       std::to_string(std::ranges::count(
           calibration.measurements, calibrator::Role::fit, &Measurement::role)));
  fact("free parameters", std::to_string(calibration.free.size()));
  fact("evaluations",
       std::to_string(fit.evaluations) + " of " + std::to_string(calibration.budget.evaluations));
  if (fit.failed > 0) fact("of these failed", std::to_string(fit.failed));
  fact("fidelity", fidelity_text(calibration));
  return text + "</dl>\n</div>\n";
}

std::string measurement_row(const FitLine& line) {
  const Measurement& measurement = line.measured.front();
  const engine::Unit& unit = measurement.unit;
  std::string note = line.is_curve() ? "" : settings_label(measurement.experiment);
  if (held_out(measurement)) {
    note += note.empty() ? "held out" : ", held out";
  }
  std::string text = "<tr><td>" + escaped(line_label(line.measured));
  if (!note.empty()) text += element("small", note);
  if (!measurement.source.empty()) text += element("small", measurement.source);
  text += "</td><td data-head=\"measured\"><span>" + escaped(measured_text(line));
  double allowance = 0.0;
  for (const Measurement& point : line.measured) allowance = std::max(allowance, point.allowance);
  if (allowance > 0.0) {
    text += "<small class=\"warning\">allowance " +
            escaped(number_text(allowance / unit.factor) + unit_suffix(unit)) + "</small>";
  }
  return text + "</span></td>" + cell("predicted", predicted_text(line)) +
         cell("difference", difference_text(line)) + cell("z", z_text(line), grade(line.z())) +
         "</tr>\n";
}

std::string measurements_section(const Calibration& calibration, const Fit& fit) {
  std::string text =
      "<section>\n<h2>Measured and predicted</h2>\n<div class=\"scroll\"><table>\n"
      "<tr><th>measurement</th><th>measured</th><th>predicted</th>"
      "<th>difference</th><th>z</th></tr>\n";
  for (const FitLine& line : lines_of(calibration, fit)) text += measurement_row(line);
  text += "</table></div>\n";
  text += element("p",
                  "± is one standard error. z is the difference in combined standard errors of "
                  "measurement, stated allowance and simulation. Predicted values are means of "
                  "fresh replicates at the best set. A curve is one line: its ends, and the root "
                  "mean square (rms) over its points.",
                  "quiet-text");
  text += "\n<div class=\"pair\">\n<div><h3>Each in its own unit</h3>\n" +
          parity_chart(calibration, fit) +
          "</div>\n<div><h3>Differences in standard errors</h3>\n" +
          residual_chart(calibration, fit) + "</div>\n</div>\n</section>\n";
  return text;
}

std::string pictures_section(std::span<const ReportPicture> pictures) {
  if (pictures.empty()) return {};
  std::string text = "<section>\n<h2>The bed at the best set</h2>\n<div class=\"pair\">\n";
  for (const ReportPicture& picture : pictures) {
    text += "<figure><img alt=\"" + escaped(picture.title) + "\" width=\"" +
            std::to_string(picture.image.width) + "\" height=\"" +
            std::to_string(picture.image.height) + "\" src=\"data:image/png;base64," +
            base64(print_png(picture.image)) + "\"><figcaption>" + element("b", picture.title) +
            "<br>" + escaped(picture.caption) + "</figcaption></figure>\n";
  }
  return text + "</div>\n</section>\n";
}

std::string parameter_row(const Calibration& calibration, std::size_t index, const Fit& fit) {
  const FittedParameter& fitted = fit.parameters[index];
  const calibrator::FreeParameter& free = calibration.free.at(index);
  const auto shown = [&](double value) { return number_text(value / free.unit.factor, 3); };
  std::string interval = shown(fitted.lower) + " to " + shown(fitted.upper);
  if (fitted.lower_at_bound && fitted.upper_at_bound) {
    interval += " (both bounds)";
  } else if (fitted.lower_at_bound || fitted.upper_at_bound) {
    interval += fitted.lower_at_bound ? " (lower bound)" : " (upper bound)";
  }
  std::string posterior = "-";
  if (index < fit.posterior.quantiles.size()) {
    const auto& quantiles = fit.posterior.quantiles[index];
    posterior = shown(quantiles.front()) + " to " + shown(quantiles.back());
  }
  return "<tr>" + element("td", parameter_label(free.key)) +
         cell("best", shown(fitted.value) + unit_suffix(free.unit)) +
         cell("95 % interval", interval) + cell("90 % of posterior", posterior) +
         cell("learnt", fixed_text(100.0 * std::max(0.0, fitted.learnt), 0) + " %") +
         cell("",
              fitted.determined ? "determined" : "not determined",
              fitted.determined ? "" : "open") +
         "</tr>\n";
}

std::string parameters_section(const Calibration& calibration, const Fit& fit) {
  std::string text =
      "<section>\n<h2>Free parameters</h2>\n<div class=\"scroll\"><table>\n"
      "<tr><th>parameter</th><th>best</th><th>95 % interval</th>"
      "<th>90 % of posterior</th><th>learnt</th><th></th></tr>\n";
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    text += parameter_row(calibration, i, fit);
  }
  text += "</table></div>\n";
  text +=
      element("p",
              "The 95 % interval is where some set fits almost as well as the best, by profile "
              "likelihood; the posterior weighs all sets. "
              "Learnt is the share of the prior variance that the data removed. A parameter "
              "whose interval reaches a bound is not determined: its hatched range fits as well "
              "as its best value.",
              "quiet-text");
  text += "\n<div class=\"pair\">\n<div><h3>Bounds, best values and 95 % intervals</h3>\n" +
          interval_chart(calibration, fit) + "</div>\n";
  if (fit.directions.size() > 1) {
    text += "<div><h3>Combinations that the data fix</h3>\n" + direction_chart(calibration, fit) +
            element("p",
                    "A column is a combination of parameters, best learnt first: circles of one "
                    "colour change together, of the other against them.",
                    "quiet-text") +
            "</div>\n";
  }
  return text + "</div>\n</section>\n";
}

std::string next_section(const Calibration& calibration, const Fit& fit) {
  const std::vector<std::string> sentences = next_sentences(calibration, fit);
  if (sentences.empty()) return {};
  std::string text = "<section>\n<h2>What to measure next</h2>\n<ol>\n";
  for (const std::string& sentence : sentences) text += element("li", sentence) + "\n";
  return text + "</ol>\n" +
         element("p",
                 "Ranked by how much each would narrow the free parameters together. What the "
                 "experiments of the study show besides what was measured, and each measurement "
                 "again with half its standard error: neither needs another simulation.",
                 "quiet-text") +
         "\n</section>\n";
}

std::string posterior_section(const Calibration& calibration, const Fit& fit) {
  if (fit.posterior.samples.empty() || calibration.free.size() < 2) return {};
  return "<section>\n<h2>The free parameters together</h2>\n" + posterior_chart(calibration, fit) +
         element("p",
                 "Samples of the joint posterior, each axis from bound to bound. A narrow slanted "
                 "cloud is a combination that the data fix while its parts stay open. " +
                     count_text(static_cast<unsigned long long>(
                         std::max(0.0, fit.posterior.effective_samples))) +
                     " effective samples, split R-hat " + fixed_text(fit.posterior.r_hat, 3) + ".",
                 "quiet-text") +
         "\n</section>\n";
}

std::string search_section(const Calibration& calibration, const Fit& fit) {
  std::string text = "<section>\n<h2>The search</h2>\n<div class=\"pair\">\n<div>" +
                     convergence_chart(calibration, fit) + "</div>\n<div>";
  if (!fit.remarks.empty()) text += "<h3>Remarks</h3>\n<ul>\n";
  for (const std::string& remark : fit.remarks) text += element("li", remark) + "\n";
  if (!fit.remarks.empty()) text += "</ul>\n";
  return text + "</div>\n</div>\n</section>\n";
}

std::string set_section(const Calibration& calibration, const Fit& fit) {
  std::string text =
      "<section>\n<h2>The best set in full</h2>\n<div class=\"scroll\"><table>\n"
      "<tr><th>parameter</th><th>value</th><th></th></tr>\n";
  for (const auto& [key, value] : fit.best) {
    const engine::Unit unit = parameter_unit(calibration, key);
    const auto tie = std::ranges::find(calibration.tied, key, &calibrator::Tie::key);
    std::string role = "fixed";
    if (std::ranges::count(calibration.free, key, &calibrator::FreeParameter::key) > 0)
      role = "free";
    if (tie != calibration.tied.end()) {
      role = number_text(tie->factor) + " x " + parameter_label(tie->to);
    }
    text += "<tr>" + element("td", parameter_label(key)) +
            cell("value", number_text(value / unit.factor) + unit_suffix(unit)) +
            cell("", role, role == "free" ? "" : "open") + "</tr>\n";
  }
  return text + "</table></div>\n</section>\n";
}

std::string provenance_section(const CalibrationDocument& document, const Provenance& provenance) {
  std::string text =
      "<section class=\"long\">\n<h2>Where this comes from</h2>\n<dl class=\"plain\">\n";
  text += described("calibration", std::to_string(document.id) + ", " + document.state);
  const auto add = [&](std::string_view term, const std::string& what) {
    if (!what.empty()) text += described(term, what);
  };
  add("engine", document.engine_version);
  add("program", provenance.program);
  if (document.calibration) add("seed", std::to_string(document.calibration->seed));
  add("database", provenance.database);
  add("created", document.created_at);
  add("finished", document.finished_at);
  add("report written", provenance.written_at);
  text += "</dl>\n";
  if (!document.study.empty()) {
    text += "<details><summary>The study document</summary>\n" + element("pre", document.study) +
            "\n</details>\n";
  }
  return text + "</section>\n";
}

std::string body(const CalibrationDocument& document, std::span<const ReportPicture> pictures) {
  if (!document.calibration || !document.fit) {
    const std::string why = document.error.empty()
                                ? "There is no fit: the calibration is " + document.state + "."
                                : document.error;
    return "<div class=\"verdict unfinished\">" + element("p", why) + "</div>\n";
  }
  const Calibration& calibration = *document.calibration;
  const Fit& fit = *document.fit;
  return verdict_section(calibration, fit) + measurements_section(calibration, fit) +
         pictures_section(pictures) + parameters_section(calibration, fit) +
         posterior_section(calibration, fit) + next_section(calibration, fit) +
         search_section(calibration, fit) + set_section(calibration, fit);
}

}  // namespace

std::string print_report(const CalibrationDocument& document,
                         std::span<const ReportPicture> pictures,
                         const Provenance& provenance) {
  const std::string name =
      document.name.empty() ? "Calibration " + std::to_string(document.id) : document.name;
  return page_head(name + ": calibration report") + "<header>" +
         element("p", "Calibration report", "kind") + element("h1", name) + "</header>\n" +
         body(document, pictures) + provenance_section(document, provenance) +
         std::string(page_foot);
}

}  // namespace repose::server
