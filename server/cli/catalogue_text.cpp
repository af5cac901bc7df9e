#include "server/cli/catalogue_text.hpp"

#include <cmath>
#include <span>
#include <sstream>

#include "engine/catalogue.hpp"
#include "server/cli/text_table.hpp"
#include "server/json/effect_bench_json.hpp"
#include "server/json/place.hpp"
#include "server/laboratory/draft_bias.hpp"
#include "server/laboratory/drawings.hpp"
#include "server/report/number_text.hpp"

namespace repose::server {

using engine::FieldInfo;

namespace {

std::string shown(double value, const FieldInfo& field) {
  if (std::isnan(value)) return "";
  const auto choice = static_cast<std::size_t>(std::max(0.0, value));
  if (choice < field.choices.size()) return std::string(field.choices[choice]);
  return number_text(value / field.unit.factor);
}

std::string row_of(const FieldInfo& field, std::string_view prefix) {
  return "| `" + std::string(prefix) + std::string(field.name) + "` | " +
         std::string(field.meaning) + " | " + std::string(field.unit.symbol) + " | " +
         shown(field.null_value, field) + " | " + shown(field.lower, field) + " to " +
         shown(field.upper, field) + " |";
}

std::string head(std::string_view fourth, std::string_view more) {
  const std::string columns(more);
  std::string rule = "| --- | --- | --- | --- | --- |";
  for (const char c : columns) rule += c == '|' ? " --- |" : "";
  return "\n| name | meaning | unit | " + std::string(fourth) + " | range |" + columns + "\n" +
         rule + "\n";
}

/// The parameters at which an effect was measured, its first material or pair standing for all.
std::string strength_of(const EffectBench& measured) {
  std::string text;
  std::string_view last;
  for (const auto& [key, value] : measured.parameters) {
    if (key.field == last) continue;
    last = key.field;
    const engine::Unit unit = engine::find_parameter(key.field)->field->unit;
    text += (text.empty() ? "" : ", ") + key.field + " " + number_text(value / unit.factor, 3) +
            unit_suffix(unit);
  }
  return text;
}

/// What the effect did in our own runs.
std::string influence_of(std::string_view effect) {
  const EffectBench* measured = measured_effect(effect);
  if (measured == nullptr) return "";
  std::string text =
      "\nAt " + strength_of(*measured) + " on the reference grain (`" + measured_effects().command +
      "`, draft fidelity; ± is one standard error):\n\n"
      "| observable | without | with | change | |\n| --- | --- | --- | --- | --- |\n";
  for (const EffectChange& change : measured->changes) {
    const double factor = change.unit.factor;
    const double difference = (change.with - change.without) / factor;
    const double error = change.standard_error / factor;
    const int decimals = decimals_for(difference, error);
    const auto shown = [&](double value) {
      return std::isfinite(value) ? fixed_text(value, decimals) : std::string("-");
    };
    const bool told = std::abs(difference) > 2.0 * error || (error == 0.0 && difference != 0.0);
    text += "| " + change.experiment + " `" + change.observable + "`" + unit_suffix(change.unit) +
            " | " + shown(change.without / factor) + " | " + shown(change.with / factor) + " | " +
            shown(difference) + " ± " + shown(error) + " | " +
            (!change.failure.empty() ? change.failure
             : !told                 ? "no change seen"
                     : fixed_text(100.0 * (change.with / change.without - 1.0), 1) + " %") +
            " |\n";
  }
  return text;
}

std::string effect_section(const engine::EffectInfo& effect) {
  const std::string name(effect.text.name);
  std::string text = "\n### " + std::string(effect.text.title) + " (`" + name + "`)\n\n" +
                     std::string(effect.text.summary) + " Given per " +
                     std::string(engine::scope_names.at(static_cast<std::size_t>(effect.scope))) +
                     "; acts at the stage " +
                     std::string(engine::stage_names.at(static_cast<std::size_t>(effect.stage))) +
                     ". Source: " + std::string(effect.text.citation) + ".\n" + head("null", "");
  for (const FieldInfo& field : effect.fields) text += row_of(field, name + ".") + "\n";
  return text + influence_of(name);
}

std::string experiment_section(const engine::ExperimentInfo& info) {
  std::string text =
      "\n### " + std::string(info.title) + " (`" + std::string(info.name) + "`)\n\n" +
      std::string(info.procedure) + " Source: " + std::string(info.citation) + ".\n\n```" +
      std::string(drawing_of(info.name)) + "\n```\n\n| observable | meaning | unit | draft |\n" +
      "| --- | --- | --- | --- |\n";
  for (const engine::ObservableInfo& seen : info.observables) {
    text += "| `" + std::string(seen.name) + "` | " + std::string(seen.meaning) + " | " +
            std::string(seen.unit.symbol) + " | " + draft_words(info, seen) + " |\n";
  }
  text += head("standard", " draft | paper |");
  for (const FieldInfo& field : info.settings) {
    text += row_of(field, "") + " " + shown(field.draft, field) + " | " +
            shown(field.paper, field) + " |\n";
  }
  return text;
}

/// Words in lines of at most 88 letters.
std::string wrapped(std::string_view words) {
  constexpr std::size_t longest = 88;
  std::string text, line;
  std::istringstream stream{std::string(words)};
  for (std::string word; stream >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > longest) {
      text += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return text + line + "\n";
}

std::string with_unit(double value, const FieldInfo& field) {
  const std::string text = shown(value, field);
  return field.choices.empty() && !text.empty() ? text + unit_suffix(field.unit) : text;
}

}  // namespace

std::string explanation(const engine::ExperimentInfo& info) {
  const std::string name(info.name);
  std::string text = std::string(info.title) + " (" + name + ")\n\n" + wrapped(info.summary) +
                     std::string(drawing_of(info.name)) + "\n\n" + wrapped(info.procedure) + "\n";
  TextTable observables({"reads", "unit", "which is"}, "lll");
  std::string drafts;
  for (const engine::ObservableInfo& seen : info.observables) {
    observables.row(
        {std::string(seen.name), std::string(seen.unit.symbol), std::string(seen.meaning)});
    if (const std::string words = draft_words(info, seen); !words.empty()) {
      drafts += std::string(seen.name) + ": " + words + "\n";
    }
  }
  TextTable settings({"--setting", "draft", "standard", "paper", "range", "which is"}, "lrrrrl");
  for (const FieldInfo& field : info.settings) {
    const auto or_standard = [&](double value) {
      return with_unit(std::isnan(value) ? field.null_value : value, field);
    };
    settings.row({std::string(field.name),
                  or_standard(field.draft),
                  with_unit(field.null_value, field),
                  or_standard(field.paper),
                  field.choices.empty()
                      ? shown(field.lower, field) + " to " + with_unit(field.upper, field)
                      : listed(field.choices),
                  std::string(field.meaning)});
  }
  return text + observables.str() + "\n" + (drafts.empty() ? "" : drafts + "\n") + settings.str() +
         "\nTry\n  repose evaluate " + name + " --fidelity draft\n  repose evaluate " + name +
         " --fidelity draft --frames " + name +
         "/    # a picture of every stage, and play.html\n\nSource: " + std::string(info.citation) +
         "\n";
}

std::string catalogue_markdown() {
  std::string text =
      "# Catalogue\n\nPrinted by `repose catalogue --markdown`.\n\n## Materials\n" + head("", "");
  for (const FieldInfo& field : engine::material_catalogue()) {
    text += row_of(field, "material.") + "\n";
  }
  text += "\n## Effects\n\nAt its null value an effect is exactly absent.\n";
  for (const auto& effect : engine::effect_catalogue()) text += effect_section(effect);
  text += "\n## Experiments\n";
  for (const auto& info : engine::experiment_catalogue()) text += experiment_section(info);
  return text;
}

}  // namespace repose::server
