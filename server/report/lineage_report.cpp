#include "server/report/lineage_report.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "server/report/chart_lineage.hpp"
#include "server/report/diagnosis_words.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"
#include "server/report/page.hpp"
#include "server/report/svg.hpp"

namespace repose::server {

using calibrator::Comparison;
using calibrator::Diagnosis;
using calibrator::EffectFinding;
using calibrator::Refit;

namespace {

/// The first diagnosis of the lineage: what the base model lacks. Nothing where none was made.
const Generation* diagnosed(const Lineage& lineage) {
  const auto found = std::ranges::find_if(
      lineage, [](const Generation& generation) { return generation.diagnosis.has_value(); });
  return found == lineage.end() ? nullptr : &*found;
}

std::string z_text(double z) { return std::isfinite(z) ? fixed_text(z, 2) : "-"; }

/// "2.21 → 0.87", or the one there is.
std::string change_text(const Lineage& lineage, double Comparison::*member, int decimals) {
  const auto shown = [&](const Generation& generation) {
    const double value = generation.comparison.*member;
    return std::isfinite(value) ? fixed_text(value, decimals) : std::string("-");
  };
  if (lineage.size() == 1) return shown(lineage.front());
  return shown(lineage.front()) + " → " + shown(lineage.back());
}

std::string verdict_style(const Lineage& lineage) {
  constexpr double fits = 0.02;  // as the diagnosis judges a misfit
  const Comparison& last = lineage.back().comparison;
  const auto& diagnosis = lineage.back().diagnosis;
  if (diagnosis && diagnosis->verdict == calibrator::DiagnosisVerdict::not_predicted) {
    return "verdict missed";
  }
  if (last.p >= fits) return "verdict hit";
  return lineage.size() > 1 && last.misfit < 0.5 * lineage.front().comparison.misfit
             ? "verdict met"
             : "verdict missed";
}

std::string open_effects(const Diagnosis& diagnosis) {
  std::string text;
  for (const EffectFinding& finding : diagnosis.effects) {
    if (finding.status != calibrator::EffectStatus::not_testable) continue;
    text += (text.empty() ? "" : ", ") + finding.suspect.title;
  }
  return text;
}

/// What adding effects has done, in a sentence.
std::string outcome_sentence(const Lineage& lineage) {
  if (lineage.size() == 1) return {};
  std::string added;
  for (std::size_t g = 1; g < lineage.size(); ++g) {
    added += (g == 1 ? "" : " and ") + model_name(lineage[g]).substr(2);
  }
  const Comparison &before = lineage.front().comparison, &after = lineage.back().comparison;
  std::string text = "With " + added + " added, the fitted measurements are off by " +
                     z_text(after.fitted_z) + " standard errors in place of " +
                     z_text(before.fitted_z);
  if (std::isfinite(after.held_out_z)) {
    text += ", those held out by " + z_text(after.held_out_z) + " in place of " +
            z_text(before.held_out_z);
  }
  return text + ".";
}

std::string verdict_section(const Lineage& lineage) {
  const Generation* asked = diagnosed(lineage);
  std::string text = "<div class=\"" + verdict_style(lineage) + "\">\n";
  if (asked != nullptr) {
    const auto grade = static_cast<std::size_t>(asked->diagnosis->grade);
    const std::string badge(calibrator::grade_names[grade]);
    text += "<p>";
    if (!badge.empty()) text += "<b class=\"badge\">" + badge + "</b> ";
    text += escaped(asked->diagnosis->sentence) + "</p>\n";
  } else {
    text += element("p", "No diagnosis has been made of this model.") + "\n";
  }
  if (const std::string outcome = outcome_sentence(lineage); !outcome.empty()) {
    text += element("p", outcome) + "\n";
  }
  if (asked != nullptr) {
    if (const std::string open = open_effects(*asked->diagnosis); !open.empty()) {
      text += element("p", "These data cannot test: " + open + ".", "quiet-text") + "\n";
    }
  }
  text += "<dl class=\"facts\">\n";
  const auto fact = [&](std::string_view term, std::string_view what) {
    text += "<div>" + described(term, what) + "</div>";
  };
  fact("rms error, fitted", change_text(lineage, &Comparison::fitted_z, 2));
  fact("rms error, held out", change_text(lineage, &Comparison::held_out_z, 2));
  fact("misfit", change_text(lineage, &Comparison::misfit, 1));
  fact("degrees of freedom", change_text(lineage, &Comparison::freedom, 0));
  if (asked != nullptr && !asked->diagnosis->refits.empty()) {
    const Refit& best = asked->diagnosis->refits.front();
    std::string strength = fixed_text(best.strengths.front(), 2);
    if (!best.strength_lower.empty()) {
      strength += " (" + fixed_text(best.strength_lower.front(), 2) + " to " +
                  fixed_text(best.strength_upper.front(), 2) + ")";
    }
    fact("strength, 95 %", strength);
  }
  return text + "</dl>\n</div>\n";
}

std::string parity_section(const Lineage& lineage) {
  return "<section>\n<h2>Measured and predicted, before and after</h2>\n" + model_legend(lineage) +
         "<p class=\"legend\"><span><i class=\"part-one\"></i>measurement</span> <span><i "
         "class=\"part-two\"></i>and scatter of the runs</span> <span><i "
         "class=\"part-three\"></i>and tolerance of the code</span></p>\n<div class=\"panels\">\n" +
         parity_panels(lineage) + "</div>\n" +
         element("p",
                 "On the line a prediction is right. The bars are one standard error long to "
                 "either side, part added to part: a right model is off by as much.",
                 "quiet-text") +
         "\n</section>\n";
}

std::string error_section(const Lineage& lineage) {
  return "<section>\n<h2>Where the error was, and what is left of it</h2>\n" +
         model_legend(lineage) +
         "<div class=\"pair\">\n<div><h3>Each measurement, in standard errors</h3>\n" +
         residual_map(lineage) +
         element("p",
                 "Blue is too low, orange too high; hatched differences lie within the tolerance "
                 "of the code alone.",
                 "quiet-text") +
         "</div>\n<div><h3>Each experiment</h3>\n" + waterfall_chart(lineage) +
         "</div>\n</div>\n</section>\n";
}

std::string trend_section(const Lineage& lineage) {
  const std::string panels = trend_panels(lineage);
  if (panels.empty()) return {};
  return "<section>\n<h2>Differences along the conditions</h2>\n" + model_legend(lineage) +
         "<div class=\"panels\">\n" + panels + "</div>\n" +
         element("p",
                 "Predicted less measured, in standard errors. What a model lacks shows as a "
                 "slope; bands are one and two standard errors.",
                 "quiet-text") +
         "\n</section>\n";
}

std::string meter(double share) {
  const double clamped = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0;
  return "<span class=\"meter\"><i style=\"width:" + fixed_text(100.0 * clamped, 0) +
         "%\"></i></span>";
}

std::string metered(std::string_view head, double share, const std::string& words) {
  return "<td data-head=\"" + escaped(head) + "\"><span>" + escaped(words) + meter(share) +
         "</span></td>";
}

std::string interval_text(const Refit& refit) {
  std::string text = fixed_text(refit.strengths.front(), 2);
  if (!refit.strength_lower.empty()) {
    text += " (" + fixed_text(refit.strength_lower.front(), 2) + " to " +
            fixed_text(refit.strength_upper.front(), 2) + ")";
  }
  return text;
}

std::string effect_row(const Diagnosis& diagnosis, std::size_t effect, double most) {
  const EffectFinding& finding = diagnosis.effects[effect];
  const Refit* refit = refit_of(diagnosis, effect);
  const bool probed = finding.status != calibrator::EffectStatus::not_probed;
  const double evidence = refit != nullptr ? refit->gain : finding.score;
  std::string text = "<tr><td>" + escaped(finding.suspect.title) +
                     element("small", reason(diagnosis, effect), "reason") + "</td>";
  text += cell(
      "status",
      status_text(finding.status),
      "chip " +
          std::string(calibrator::effect_status_names[static_cast<std::size_t>(finding.status)]));
  if (!probed) {
    for (const char* head : {"evidence", "p", "strength", "absorbed"}) text += cell(head, "-");
    return text + "</tr>\n";
  }
  text += metered("evidence", most > 0.0 ? evidence / most : 0.0, fixed_text(evidence, 1));
  text += cell("p", chance_text(finding.p));
  text +=
      cell("strength", refit != nullptr ? interval_text(*refit) : fixed_text(finding.strength, 2));
  text += metered("absorbed", finding.absorbed, fixed_text(100.0 * finding.absorbed, 0) + " %");
  return text + "</tr>\n";
}

std::string ranking_section(const Generation& generation) {
  const Diagnosis& diagnosis = *generation.diagnosis;
  double most = 0.0;
  for (const EffectFinding& finding : diagnosis.effects) most = std::max(most, finding.score);
  for (const Refit& refit : diagnosis.refits) most = std::max(most, refit.gain);
  std::string text = "<section>\n<h2>What could be missing from the " +
                     escaped(model_name(generation)) + "</h2>\n<div class=\"scroll\"><table " +
                     "class=\"ranking\">\n<tr><th>effect</th><th>status</th><th>evidence</th>" +
                     "<th>p</th><th>strength</th><th>absorbed</th></tr>\n";
  std::string traceless;
  for (const std::size_t effect : ranked(diagnosis)) {
    const EffectFinding& finding = diagnosis.effects[effect];
    if (finding.status == calibrator::EffectStatus::not_testable && leaves_no_trace(finding)) {
      traceless += (traceless.empty() ? "" : ", ") + finding.suspect.title;
    } else {
      text += effect_row(diagnosis, effect, most);
    }
  }
  text += "</table></div>\n";
  if (!traceless.empty()) {
    text += element("p", "Nothing to these measurements: " + traceless + ".", "quiet-text");
  }
  text += element("p",
                  "Evidence is by how much -2 log likelihood falls; p the chance that any effect "
                  "scores so high where nothing is missing; strength 1 is strong but plausible; "
                  "absorbed is the share of its trace that the free parameters imitate.",
                  "quiet-text");
  if (!diagnosis.excuses.empty()) {
    const calibrator::Excuse& excuse = diagnosis.excuses.front();
    std::string name = excuse.observable;
    std::ranges::replace(name, '.', ' ');
    std::ranges::replace(name, '_', ' ');
    text += element("p",
                    "Best excuse without physics: " + name +
                        (excuse.setting.empty() ? " is off" : " changes along " + excuse.setting) +
                        " by " + fixed_text(100.0 * excuse.size, 1) + " %, misfit " +
                        fixed_text(excuse.misfit, 1) + ".",
                    "quiet-text");
  }
  for (const std::string& remark : diagnosis.remarks) text += element("p", remark, "quiet-text");
  return text + "\n</section>\n";
}

std::string fingerprint_section(const Generation& generation) {
  const std::string panels = fingerprint_panels(generation);
  if (panels.empty()) return {};
  return "<section>\n<h2>Fingerprints</h2>\n<p class=\"legend\"><span><i "
         "class=\"missing\"></i>what "
         "the " +
         escaped(model_name(generation)) +
         " lacks</span> <span><i class=\"raw\"></i>what the effect does</span> <span><i "
         "class=\"projected\"></i>what of that no free parameter imitates</span></p>\n<div "
         "class=\"panels\">\n" +
         panels + "</div>\n</section>\n";
}

/// What to measure next, with what each open explanation expects of it.
std::string next_section(const Generation& generation) {
  const Diagnosis& diagnosis = *generation.diagnosis;
  if (diagnosis.next.empty()) return {};
  std::string text =
      "<section>\n<h2>What to measure next</h2>\n<div class=\"scroll\"><table>\n"
      "<tr><th>measurement</th>";
  std::vector<std::string> rivals;
  for (const auto& effects : diagnosis.rivals) {
    rivals.push_back("with " + names_text(diagnosis, effects));
    text += element("th", rivals.back());
  }
  text += "<th>would be known to</th><th>evidence</th></tr>\n";
  for (const calibrator::DecidingMeasurement& next : diagnosis.next) {
    calibrator::Measurement what;
    what.experiment = next.experiment;
    what.observable = next.observable;
    const double factor = next.unit.factor, error = next.standard_error / factor;
    text += "<tr><td>" + escaped(measurement_label(what)) +
            element("small", settings_label(next.experiment)) + "</td>";
    for (std::size_t r = 0; r < next.predicted.size() && r < rivals.size(); ++r) {
      const double value = next.predicted[r] / factor;
      text +=
          cell(rivals[r], fixed_text(value, decimals_for(value, error)) + unit_suffix(next.unit));
    }
    text += cell("would be known to",
                 "± " + fixed_text(error, decimals_for(error, error)) + unit_suffix(next.unit));
    text += cell("evidence", fixed_text(next.evidence, 1)) + "</tr>\n";
  }
  return text + "</table></div>\n" +
         element("p",
                 "Measurements on which the open explanations differ most; evidence is their "
                 "largest difference in squared standard errors.",
                 "quiet-text") +
         "\n</section>\n";
}

std::string shift_section(const Lineage& lineage) {
  return "<section>\n<h2>Parameters, before and after</h2>\n" + model_legend(lineage) +
         "<div class=\"half\">" + shift_chart(lineage) + "</div>\n" +
         element(
             "p", "Each within the bounds of its search, with its 95 % interval.", "quiet-text") +
         "\n</section>\n";
}

std::string lineage_row(const Generation& generation) {
  const Comparison& comparison = generation.comparison;
  std::string verdict = "not diagnosed";
  if (generation.diagnosis) {
    verdict = std::string(calibrator::diagnosis_verdict_names[static_cast<std::size_t>(
        generation.diagnosis->verdict)]);
    std::ranges::replace(verdict, '_', ' ');
    const auto grade = static_cast<std::size_t>(generation.diagnosis->grade);
    if (grade > 0) verdict += ", grade " + std::string(calibrator::grade_names[grade]);
  }
  return "<tr><td>" + escaped(model_name(generation)) +
         element("small", "calibration " + std::to_string(generation.document.id)) + "</td>" +
         cell("free", std::to_string(generation.calibration().free.size())) +
         cell("misfit / freedom",
              fixed_text(comparison.misfit, 1) + " / " + fixed_text(comparison.freedom, 0)) +
         cell("p", chance_text(comparison.p)) + cell("fitted", z_text(comparison.fitted_z)) +
         cell("held out", z_text(comparison.held_out_z)) +
         cell("runs", std::to_string(generation.fit().evaluations)) + cell("diagnosis", verdict) +
         "</tr>\n";
}

std::string lineage_section(const Lineage& lineage, const Provenance& provenance) {
  std::string text =
      "<section class=\"long\">\n<h2>The lineage</h2>\n<div class=\"scroll\"><table>\n<tr><th>model"
      "</th><th>free</th><th>misfit / freedom</th><th>p</th><th>fitted</th><th>held out</th>"
      "<th>runs</th><th>diagnosis</th></tr>\n";
  for (const Generation& generation : lineage) text += lineage_row(generation);
  text += "</table></div>\n";
  text += element("p",
                  "p is the chance that a right model misses by so much. Fitted and held out are "
                  "root mean square differences in standard errors.",
                  "quiet-text");
  text += "\n<dl class=\"plain\">\n";
  const auto add = [&](std::string_view term, const std::string& what) {
    if (!what.empty()) text += described(term, what);
  };
  add("engine", lineage.back().document.engine_version);
  add("program", provenance.program);
  add("seed", std::to_string(lineage.front().calibration().seed));
  add("database", provenance.database);
  add("report written", provenance.written_at);
  return text + "</dl>\n</section>\n";
}

}  // namespace

std::string print_lineage_report(const Lineage& lineage, const Provenance& provenance) {
  const std::string& name = lineage.front().document.name;
  std::string models;
  for (const Generation& generation : lineage) {
    models += (models.empty() ? "" : "  ") + model_name(generation);
  }
  std::string text = page_head(name + ": what its model lacks") + "<header>" +
                     element("p", "Missing-effect report: " + models, "kind") +
                     element("h1", name) + "</header>\n" + verdict_section(lineage) +
                     parity_section(lineage) + error_section(lineage) + trend_section(lineage);
  for (const Generation& generation : lineage) {
    if (!generation.diagnosis) continue;
    text +=
        ranking_section(generation) + fingerprint_section(generation) + next_section(generation);
  }
  return text + shift_section(lineage) + lineage_section(lineage, provenance) +
         std::string(page_foot);
}

}  // namespace repose::server
