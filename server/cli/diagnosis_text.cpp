#include "server/cli/diagnosis_text.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/catalogue.hpp"
#include "server/cli/next_command.hpp"
#include "server/cli/text_table.hpp"
#include "server/json/diagnosis_json.hpp"
#include "server/json/missing_effect_json.hpp"
#include "server/json/report_json.hpp"
#include "server/report/diagnosis_words.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Diagnosis;
using calibrator::EffectFinding;
using calibrator::EffectStatus;
using calibrator::Measurement;

namespace {

/// `measurements`: among which it is told from the others.
std::string label_of(std::span<const Measurement> measurements, const Measurement& measurement) {
  std::string label = measurement_label(measurement);
  const std::string settings = distinction_label(measurements, measurement);
  if (!settings.empty()) label += " (" + settings + ")";
  if (held_out(measurement)) label += " (held out)";
  return label;
}

std::string z_text(double z) { return std::isfinite(z) ? fixed_text(z, 2) : "-"; }

std::string p_text(double p) { return p < 0.00025 ? "< 0.0003" : number_text(p, 2); }

/// The status in words, with the strength in the effect's own terms.
std::string status_of(const EffectFinding& finding, const engine::ParameterSet& parameters) {
  switch (finding.status) {
    case EffectStatus::supported:
      return "supported";
    case EffectStatus::not_testable:
      return leaves_no_trace(finding) ? "changes none of these measurements"
                                      : "not testable with these data";
    case EffectStatus::outdone:
      return "not needed: another explanation does better";
    case EffectStatus::not_probed:
      return "not probed: " + finding.suspect.objection;
    case EffectStatus::excluded:
      break;
  }
  if (finding.suspect.levers.empty()) return "excluded";
  const calibrator::Lever& lever = finding.suspect.levers.front();
  const engine::ParameterInfo* info = engine::find_parameter(lever.key.field);
  const engine::Unit unit = info != nullptr ? info->field->unit : engine::Unit{};
  return "excluded beyond " +
         number_text(lever.value(parameters, finding.strength_upper) / unit.factor, 2) +
         unit_suffix(unit);
}

std::string effect_table(const Diagnosis& diagnosis) {
  std::vector<const EffectFinding*> order;
  for (const EffectFinding& finding : diagnosis.effects) order.push_back(&finding);
  std::ranges::stable_sort(order, [](const auto* a, const auto* b) { return a->score > b->score; });
  TextTable table({"effect", "score", "p", "strength", "detectable", "absorbed", ""}, "lrrrrrl");
  for (const EffectFinding* finding : order) {
    const bool probed = finding->status != EffectStatus::not_probed;
    const bool traced = probed && !leaves_no_trace(*finding);
    const auto cell = [&](const std::string& text) { return traced ? text : std::string("-"); };
    table.row({finding->suspect.name,
               cell(fixed_text(finding->score, 1)),
               cell(p_text(finding->p)),
               cell(fixed_text(finding->strength, 2)),
               cell(detectable_text(*finding)),
               cell(fixed_text(100.0 * finding->absorbed, 0) + " %"),
               status_of(*finding, diagnosis.parameters)});
  }
  return table.str();
}

std::string names_of(const Diagnosis& diagnosis, const std::vector<std::size_t>& effects) {
  std::string text;
  for (const std::size_t effect : effects) {
    text += (text.empty() ? "" : " + ") + diagnosis.effects[effect].suspect.name;
  }
  return text;
}

std::string refit_table(const Diagnosis& diagnosis) {
  TextTable table(
      {"refitted", "gain", "misfit", "p", "strength", "95 % interval", "rms z fitted", "held out"});
  table.row({"(nothing added)",
             "0.0",
             fixed_text(diagnosis.misfit, 1) + " / " + fixed_text(diagnosis.freedom, 1),
             p_text(diagnosis.p_misfit),
             "-",
             "-",
             z_text(diagnosis.fitted_z),
             z_text(diagnosis.held_out_z)});
  for (const calibrator::Refit& refit : diagnosis.refits) {
    std::string strength, interval = "-";
    for (const double value : refit.strengths) {
      strength += (strength.empty() ? "" : ", ") + fixed_text(value, 2);
    }
    if (!refit.strength_lower.empty()) {
      interval = fixed_text(refit.strength_lower.front(), 2) + " to " +
                 fixed_text(refit.strength_upper.front(), 2);
    }
    table.row({names_of(diagnosis, refit.effects),
               fixed_text(refit.gain, 1),
               fixed_text(refit.misfit, 1) + " / " + fixed_text(refit.freedom, 1),
               p_text(refit.p),
               strength,
               interval,
               z_text(refit.fitted_z),
               z_text(refit.held_out_z)});
  }
  return table.str();
}

/// What would settle it, by what each explanation expects of it.
std::string next_table(const Diagnosis& diagnosis) {
  std::vector<std::string> head{"next measurement"};
  for (const auto& effects : diagnosis.rivals) {
    head.push_back(effects.empty() ? "(nothing added)" : names_of(diagnosis, effects));
  }
  head.insert(head.end(), {"+-", "evidence"});
  TextTable table(head);
  for (const calibrator::DecidingMeasurement& next : diagnosis.next) {
    Measurement measurement;
    measurement.experiment = next.experiment;
    measurement.observable = next.observable;
    const double factor = next.unit.factor;
    const int decimals =
        decimals_for(next.predicted.front() / factor, next.standard_error / factor);
    std::vector<std::string> row{label_of({}, measurement)};
    for (const double value : next.predicted) row.push_back(fixed_text(value / factor, decimals));
    row.push_back(fixed_text(next.standard_error / factor, decimals) + unit_suffix(next.unit));
    row.push_back(fixed_text(next.evidence, 1));
    table.row(std::move(row));
  }
  return table.str();
}

/// Measured against what the model says before anything is added and after the best addition.
std::string prediction_table(const Calibration& calibration, const Diagnosis& diagnosis) {
  const calibrator::Refit* best = diagnosis.refits.empty() ? nullptr : &diagnosis.refits.front();
  std::vector<std::string> head{"measurement", "measured", "model"};
  if (best != nullptr) head.push_back("+ " + names_of(diagnosis, best->effects));
  TextTable table(head);
  for (std::size_t j = 0; j < calibration.measurements.size(); ++j) {
    const Measurement& measurement = calibration.measurements[j];
    const double factor = measurement.unit.factor;
    const int decimals =
        decimals_for(measurement.value / factor, measurement.standard_error / factor);
    std::vector<std::string> row{
        label_of(calibration.measurements, measurement),
        with_error(measurement.value, measurement.standard_error, measurement.unit),
        fixed_text(diagnosis.predicted[j] / factor, decimals)};
    if (best != nullptr) row.push_back(fixed_text(best->predicted[j] / factor, decimals));
    table.row(std::move(row));
  }
  return table.str();
}

}  // namespace

std::string print_diagnosis_text(std::string_view calibration,
                                 std::string_view diagnosis,
                                 const std::filesystem::path& database) {
  const auto own = parse_document(calibration);
  if (!own) return own.error() + "\n";
  const auto record = parse_diagnosis_record(diagnosis);
  if (!record) return record.error() + "\n";
  std::string text = "Diagnosis " + std::to_string(record->id) + " of calibration " +
                     std::to_string(own->id) + ": " + own->name + " (" + record->state + ")\n";
  if (!record->error.empty()) text += record->error + "\n";
  if (!own->calibration || record->result.empty()) return text;
  const auto result = parse_diagnosis(*own->calibration, record->result);
  if (!result) return text + result.error() + "\n";
  const char* grade = calibrator::grade_names[static_cast<std::size_t>(result->grade)].data();
  text += "\n" + result->sentence;
  if (*grade != '\0') text += " [grade " + std::string(grade) + "]";
  text += "\n\nChance of so large a score where nothing is missing: effects " +
          p_text(result->p_named) + ", single apparatus " + p_text(result->p_unnamed) +
          ", misfit " + p_text(result->p_misfit) +
          (std::isfinite(result->held_out_z) ? ", held out " + p_text(result->p_held_out) : "") +
          "\n\n";
  text += effect_table(*result) + "\n" + refit_table(*result) + "\n";
  if (!result->excuses.empty()) {
    const calibrator::Excuse& excuse = result->excuses.front();
    text += "Best excuse without physics: " + excuse.observable +
            (excuse.setting.empty() ? "" : " along " + excuse.setting) + ", " +
            fixed_text(100.0 * excuse.size, 1) + " %, misfit " + fixed_text(excuse.misfit, 1) +
            "\n\n";
  }
  text += prediction_table(*own->calibration, *result);
  if (!result->next.empty()) text += "\n" + next_table(*result);
  for (const std::string& remark : result->remarks) text += "- " + remark + "\n";
  return text + "\n" + std::to_string(result->evaluations) +
         " evaluations beyond the calibration\n" + after_diagnosis(own->id, *result, database);
}

std::string print_comparison_text(std::string_view calibration, std::string_view comparison) {
  const auto own = parse_document(calibration);
  if (!own) return own.error() + "\n";
  const auto read = parse_comparison(comparison);
  if (!read) return read.error() + "\n";
  std::string text =
      "Calibration " + std::to_string(own->id) + ": " + own->name + " against its measurements\n\n";
  const bool before = read->before.has_value();
  std::vector<std::string> head{
      "measurement", "measured", "predicted", "difference", "lab", "tolerance", "runs", "z"};
  if (before) head.emplace_back("z before");
  TextTable table(head);
  for (const ComparisonRow& row : read->rows) {
    if (row.measurement >= own->calibration->measurements.size()) break;
    const Measurement& measurement = own->calibration->measurements[row.measurement];
    const int decimals = decimals_for(row.difference, row.lab);
    std::vector<std::string> cells{label_of(own->calibration->measurements, measurement),
                                   fixed_text(row.measured, decimals),
                                   fixed_text(row.predicted, decimals),
                                   fixed_text(row.difference, decimals),
                                   fixed_text(row.lab, decimals),
                                   fixed_text(row.tolerance, decimals),
                                   fixed_text(row.runs, decimals),
                                   z_text(row.z)};
    if (before) cells.push_back(z_text(row.z_before));
    table.row(std::move(cells));
  }
  text += table.str() + "\n";
  const auto quality = [](const FitQuality& fit) {
    return "misfit " + fixed_text(fit.misfit, 1) + " on " + fixed_text(fit.freedom, 0) +
           " degrees of freedom (p " + p_text(fit.p) + "), rms z " + z_text(fit.fitted_z) +
           " fitted, " + z_text(fit.held_out_z) + " held out\n";
  };
  text += quality(read->own);
  if (before) text += "Before: " + quality(*read->before);
  text += "\n";
  for (const std::string& sentence : read->sentences) text += sentence + "\n";
  for (const std::string& trend : read->trends) text += trend + "\n";
  return text;
}

}  // namespace repose::server
