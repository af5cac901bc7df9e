#include "server/cli/catalogue_text.hpp"

#include <cmath>
#include <span>

#include "engine/catalogue.hpp"
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

std::string effect_section(const engine::EffectInfo& effect) {
  const std::string name(effect.text.name);
  std::string text = "\n### " + std::string(effect.text.title) + " (`" + name + "`)\n\n" +
                     std::string(effect.text.summary) + " Given per " +
                     std::string(engine::scope_names.at(static_cast<std::size_t>(effect.scope))) +
                     "; acts at the stage " +
                     std::string(engine::stage_names.at(static_cast<std::size_t>(effect.stage))) +
                     ". Source: " + std::string(effect.text.citation) + ".\n" + head("null", "");
  for (const FieldInfo& field : effect.fields) text += row_of(field, name + ".") + "\n";
  return text;
}

std::string experiment_section(const engine::ExperimentInfo& info) {
  std::string text = "\n### " + std::string(info.title) + " (`" + std::string(info.name) +
                     "`)\n\n" + std::string(info.procedure) +
                     " Source: " + std::string(info.citation) +
                     ".\n\n| observable | meaning | unit |\n" + "| --- | --- | --- |\n";
  for (const engine::ObservableInfo& seen : info.observables) {
    text += "| `" + std::string(seen.name) + "` | " + std::string(seen.meaning) + " | " +
            std::string(seen.unit.symbol) + " |\n";
  }
  text += head("standard", " draft | paper |");
  for (const FieldInfo& field : info.settings) {
    text += row_of(field, "") + " " + shown(field.draft, field) + " | " +
            shown(field.paper, field) + " |\n";
  }
  return text;
}

}  // namespace

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
