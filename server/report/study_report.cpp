#include "server/report/study_report.hpp"

#include <cmath>
#include <string_view>

#include "server/report/chart_study.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"
#include "server/report/page.hpp"
#include "server/report/study_words.hpp"
#include "server/report/svg.hpp"
#include "server/studies/study_findings.hpp"

namespace repose::server {

namespace {

std::string table_head(std::initializer_list<std::string_view> heads) {
  std::string text = "<div class=\"scroll\"><table>\n<tr>";
  for (const std::string_view head : heads) text += element("th", head);
  return text + "</tr>\n";
}

constexpr std::string_view table_foot = "</table></div>\n";

/// The first cell of a row: a name, and what it means below.
std::string name_cell(std::string_view name, std::string_view meaning) {
  return "<td>" + escaped(name) + element("small", meaning) + "</td>";
}

std::string_view trend_style(const Trend& trend) {
  if (!trend.agrees || !trend.clear()) return "open";
  return *trend.agrees ? "good" : "poor";
}

std::string findings_section(const StudyResult& result) {
  std::string text = "<div class=\"verdict\">\n" + element("p", "What came out") + "\n<ul>\n";
  for (const std::string& sentence : findings(result)) text += element("li", sentence) + "\n";
  text += "</ul>\n<dl class=\"facts\">\n";
  const auto fact = [&](std::string_view term, const std::string& what) {
    text += "<div>" + described(term, what) + "</div>";
  };
  fact("fidelity",
       std::string(engine::fidelity_names.at(static_cast<std::size_t>(fidelity_of(result.size)))));
  for (const StudyExperiment& what : result.study->experiments) {
    fact("replicates, " + what.experiment, std::to_string(replicates_of(what, result.size)));
  }
  fact("simulations", std::to_string(result.trials));
  fact("sphere-steps", number_text(1e-9 * result.grain_steps, 3) + " billion");
  return text + "</dl>\n</div>\n";
}

std::string agreement_section(const StudyResult& result) {
  std::string text = "<section>\n<h2>Every run, the paper's and ours</h2>\n<div class=\"pair\">\n";
  for (const StudyExperiment& what : result.study->experiments) {
    text += "<div>" + element("h3", observable_text(what) + ", " + what.unit) +
            agreement_chart(result, what) + "</div>\n";
  }
  std::string targets;
  for (const StudyExperiment& what : result.study->experiments) {
    targets += (targets.empty() ? "" : " and ") + number_text(what.target, 5) + " " + what.unit;
  }
  return text + "</div>\n" +
         element(
             "p",
             "Up: here; to the right: the paper. On the straight line both are equal; dashed are "
             "the targets, " +
                 targets + ". Named are the base and the run that the authors chose.",
             "quiet-text") +
         "\n</section>\n";
}

std::string run_row(const StudyResult& result,
                    const std::string& run,
                    const StudyExperiment& what) {
  const auto& printed = result.study->run(run).printed;
  const auto paper = printed.find(what.experiment);
  if (paper == printed.end()) return {};
  const Sample& ours = result.sample(run, what.experiment);
  const Trend here = trend(result, run, what);
  return "<tr>" + name_cell(run, difference_text(*result.study, run)) +
         cell("paper", published_text(paper->second)) + cell("here", sample_text(ours)) +
         cell("difference", signed_text(ours.mean() - paper->second.mean, 1)) +
         cell("change, paper", signed_text(here.paper, 1)) +
         cell("change, here", signed_text(here.ours, 1)) +
         cell("trend", trend_text(here), trend_style(here)) + "</tr>\n";
}

std::string table_section(const StudyResult& result, const StudyTable& table) {
  std::string text = "<section class=\"long\">\n" + element("h2", table.table + ": " + table.title);
  for (const StudyExperiment& what : result.study->experiments) {
    text += element("h3", what.experiment + ": " + observable_text(what) + ", " + what.unit) +
            table_head(
                {"run", "paper", "here", "difference", "change, paper", "change, here", "trend"});
    for (const StudyGroup& group : table.groups) {
      text += "<tr><td colspan=\"7\">" + element("b", group.group) + "</td></tr>\n";
      for (const std::string& run : group.runs) text += run_row(result, run, what);
    }
    text += std::string(table_foot);
  }
  text +=
      element("p",
              "Mean (standard deviation of the replicates). A change is against the base run. A "
              "trend agrees where both changes have one sign; with ? where either change is "
              "within twice its standard error. * some replicates failed.",
              "quiet-text");
  text += "\n<div class=\"pair\">\n";
  for (const StudyExperiment& what : result.study->experiments) {
    text += "<div>" + change_chart(result, table, what) + "</div>\n";
  }
  return text + "</div>\n</section>\n";
}

std::string cost_section(const StudyResult& result) {
  const auto& experiments = result.study->experiments;
  std::string text =
      "<section>\n<h2>Table 10: computing time</h2>\n<div "
      "class=\"scroll\"><table>\n<tr><th>run</th>";
  for (const StudyExperiment& what : experiments) {
    text += element("th", what.experiment + ", paper") + element("th", what.experiment + ", here");
  }
  text += "</tr>\n";
  for (const StudyRun& run : result.study->computing_hours) {
    text += "<tr>" + name_cell(run.run, difference_text(*result.study, run.run));
    for (const StudyExperiment& what : experiments) {
      const CostRatio ratio = cost_ratio(result, run.run, what.experiment);
      text += cell(what.experiment + ", paper", known_text(ratio.paper, 2)) +
              cell(what.experiment + ", here", known_text(ratio.ours, 2));
    }
    text += "</tr>\n";
  }
  text +=
      std::string(table_foot) +
      element("p",
              "Computing for a simulated second over that of the base run: the paper's from its "
              "hours, ours from sphere-steps (spheres moved by a step), which do not depend on "
              "the machine or on what else it does.",
              "quiet-text");
  text += "\n<div class=\"pair\">\n";
  for (const StudyExperiment& what : experiments) {
    text += "<div>" + cost_chart(result, what) + "</div>\n";
  }
  return text + "</div>\n</section>\n";
}

std::string best_row(const StudyResult& result, const StudyExperiment& what) {
  const std::string& best = result.study->best;
  const auto with_percent = [&](double value, const std::string& shown) {
    return shown + ", " + signed_text(100.0 * (value / what.target - 1.0), 2) + " %";
  };
  const Sample& ours = result.search->samples.at(what.experiment);
  const Sample& theirs = result.sample(best, what.experiment);
  const PublishedNumber& printed = result.study->run(best).printed.at(what.experiment);
  return "<tr>" + name_cell(what.experiment, observable_text(what) + ", " + what.unit) +
         cell("target", fixed_text(what.target, 1)) +
         cell("calibrator's set", with_percent(ours.mean(), sample_text(ours))) +
         cell(best + " here", with_percent(theirs.mean(), sample_text(theirs))) +
         cell(best + ", paper", with_percent(printed.mean, published_text(printed))) + "</tr>\n";
}

std::string steps_row(const StudyResult& result, const StudyExperiment& what) {
  const auto million = [](const Sample& sample) {
    return number_text(1e-6 * sample.grain_steps, 3);
  };
  return "<tr>" + name_cell("cost, " + what.experiment, "million sphere-steps a replicate") +
         cell("target", "") +
         cell("calibrator's set", million(result.search->samples.at(what.experiment))) +
         cell("there", million(result.sample(result.study->best, what.experiment))) +
         cell("paper", "-") + "</tr>\n";
}

std::string search_section(const StudyResult& result) {
  if (!result.search || result.search->samples.empty()) return {};
  const SearchResult& search = *result.search;
  const std::string& best = result.study->best;
  std::string text =
      "<section>\n<h2>The best set, found automatically</h2>\n" +
      table_head({"", "target", "calibrator's set", best + " here", best + ", paper"});
  for (const StudyExperiment& what : result.study->experiments) text += best_row(result, what);
  for (const StudyExperiment& what : result.study->experiments) text += steps_row(result, what);
  text += std::string(table_foot) + "<h3>The sets</h3>\n" +
          table_head({"parameter", "calibrator's", "95 % interval", best});
  const engine::ParameterSet theirs = run_parameters(*result.study, best);
  for (std::size_t i = 0; i < search.fit.parameters.size(); ++i) {
    const calibrator::FittedParameter& fitted = search.fit.parameters[i];
    const double factor = search.calibration.free.at(i).unit.factor;
    text += "<tr>" + element("td", parameter_label(fitted.key)) +
            cell("calibrator's", number_text(fitted.value / factor, 3)) +
            cell("95 % interval",
                 number_text(fitted.lower / factor, 3) + " to " +
                     number_text(fitted.upper / factor, 3) +
                     (fitted.determined ? "" : ", not determined")) +
            cell(best, number_text(theirs.get_or(fitted.key, 0.0) / factor, 3)) + "</tr>\n";
  }
  return text + std::string(table_foot) +
         element(
             "p",
             std::to_string(search.fit.evaluations) +
                 " evaluations of both experiments within the paper's levels, at 1.04 MPa as the "
                 "authors chose for its cost. Both sets are equally stiff: their cost differs "
                 "by the smallest grain, which sets the time step. The values are of fresh "
                 "replicates.",
             "quiet-text") +
         "\n</section>\n";
}

std::string why_section(const StudyResult& result) {
  const PublishedStudy& study = *result.study;
  std::string text = "<section class=\"long\">\n<h2>Why the numbers differ</h2>\n" +
                     element("p",
                             "The base run with one thing changed that the paper does not state. "
                             "Nothing here was adjusted to come nearer to the paper.") +
                     "\n";
  for (const StudyExperiment& what : study.experiments) {
    text += element("h3",
                    observable_text(what) + ", " + what.unit + ": " +
                        sample_text(result.sample(study.base, what.experiment)) + " here, " +
                        published_text(study.run(study.base).printed.at(what.experiment)) +
                        " in the paper") +
            table_head({"variant", "value", "change", "of the gap", "left"});
    for (const StudyVariant& variant : study.variants) {
      const auto explained = explain(result, variant.variant, what);
      if (!explained) continue;
      text += "<tr>" + name_cell(variant.kind + ": " + variant.variant, variant.meaning) +
              cell("value", sample_text(explained->sample)) +
              cell("change",
                   signed_text(explained->change, 1) + " ± " + known_text(explained->error, 1)) +
              cell("of the gap", signed_text(100.0 * explained->share, 0) + " %") +
              cell("left", signed_text(explained->left, 1)) + "</tr>\n";
    }
    text += std::string(table_foot) + variant_chart(result, what);
  }
  return text +
         element("p",
                 "± is one standard error of the change. Of the gap: the share of the difference "
                 "between the paper's base and ours that the change closes; shares of several "
                 "changes need not add up. Left: the variant less the paper.",
                 "quiet-text") +
         "\n</section>\n";
}

std::string drop_section(const StudyResult& result) {
  std::string text =
      "<section class=\"long\">\n<h2>Drop test: the restitution given and read</h2>\n" +
      table_head({"run", "given", "read", "deviation, %", "paper, %"});
  for (const DropRow& row : drop_rows(result)) {
    std::string paper = "-";
    if (row.paper) {
      paper = number_text(row.paper->percent_low, 3);
      if (row.paper->percent_high != row.paper->percent_low) {
        paper += " to " + number_text(row.paper->percent_high, 3);
      }
    }
    text += "<tr>" + name_cell(row.run, difference_text(*result.study, row.run)) +
            cell("given", number_text(row.given)) + cell("read", known_text(row.read, 4)) +
            cell("deviation, %", signed_text(row.percent, 2)) + cell("paper, %", paper) + "</tr>\n";
  }
  return text + std::string(table_foot) +
         element("p",
                 "A sphere of mean volume, released without spin, whatever the shape of the run's "
                 "grains: the test has nothing random and is run once.",
                 "quiet-text") +
         "\n</section>\n";
}

std::string provenance_section(const StudyResult& result, const StudyProvenance& provenance) {
  std::string text = "<section>\n<h2>How the paper was read</h2>\n<ul>\n";
  for (const std::string& sentence : result.study->reading) text += element("li", sentence) + "\n";
  text += "</ul>\n<dl class=\"plain\">\n" + described("source", result.study->citation) +
          described("engine", result.engine_version) + described("command", provenance.command) +
          described("report written", provenance.written_at);
  return text + "</dl>\n</section>\n";
}

}  // namespace

std::string print_study_report(const StudyResult& result, const StudyProvenance& provenance) {
  const PublishedStudy& study = *result.study;
  std::string text = page_head(study.title) + "<header>" +
                     element("p", "A published study, run again", "kind") +
                     element("h1", study.title) + element("p", study.citation) + "</header>\n" +
                     findings_section(result) + agreement_section(result);
  for (const StudyTable& table : study.tables) text += table_section(result, table);
  return text + cost_section(result) + search_section(result) + why_section(result) +
         drop_section(result) + provenance_section(result, provenance) + std::string(page_foot);
}

}  // namespace repose::server
