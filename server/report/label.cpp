#include "server/report/label.hpp"

#include <algorithm>

#include "calibrator/comparison.hpp"
#include "engine/catalogue.hpp"
#include "server/report/number_text.hpp"

namespace repose::server {

namespace {

std::string words(std::string_view name) {
  std::string text(name);
  std::ranges::replace(text, '_', ' ');
  return text;
}

}  // namespace

std::string parameter_label(const engine::ParameterKey& key) {
  const std::string_view field = key.field;
  const std::size_t point = field.find('.');
  std::string text = words(field.substr(0, point));
  const std::string_view property = point == field.npos ? "" : field.substr(point + 1);
  if (text == engine::Material::name) {
    text = words(property);
  } else if (!property.empty() && property != "coefficient") {
    text += " " + words(property);
  }
  const char* separator = " (";
  for (const engine::MaterialId id : key.between) {
    text += separator;
    text += engine::material_names[static_cast<std::size_t>(id)];
    separator = "-";
  }
  return key.between.empty() ? text : text + ")";
}

std::string measurement_label(const calibrator::Measurement& measurement) {
  return words(measurement.experiment.name) + ": " + words(measurement.observable);
}

std::string settings_label(const engine::Experiment& experiment) {
  const engine::ExperimentInfo* info = engine::find_experiment(experiment.name);
  std::string text;
  for (const auto& [name, value] : experiment.settings) {
    if (!text.empty()) text += ", ";
    text += words(name) + " ";
    const engine::FieldInfo* field = nullptr;
    if (info != nullptr) {
      const auto found = std::ranges::find(info->settings, name, &engine::FieldInfo::name);
      if (found != info->settings.end()) field = &*found;
    }
    const auto choice = static_cast<std::size_t>(std::max(0.0, value));
    if (field != nullptr && choice < field->choices.size()) {
      text += field->choices[choice];
    } else {
      const engine::Unit unit = field != nullptr ? field->unit : engine::unit::one;
      text += number_text(value / unit.factor) + unit_suffix(unit);
    }
  }
  return text;
}

std::string distinction_label(std::span<const calibrator::Measurement> measurements,
                              const calibrator::Measurement& own) {
  engine::Experiment shown = own.experiment;
  shown.settings.clear();
  for (const std::string& name :
       calibrator::differing_settings(measurements, calibrator::observable_name(own))) {
    shown.settings[name] = calibrator::setting_of(own, name);
  }
  return settings_label(shown.settings.empty() ? own.experiment : shown);
}

std::string line_label(std::span<const calibrator::Measurement> line) {
  const std::string label = measurement_label(line.front());
  if (line.size() == 1) return label;
  return label + ", " + std::to_string(line.size()) + " points along " +
         words(calibrator::setting_along(line));
}

engine::Unit observable_unit(const calibrator::Calibration& calibration,
                             std::string_view experiment,
                             std::string_view observable) {
  for (const calibrator::Measurement& m : calibration.measurements) {
    if (m.experiment.name == experiment && m.observable == observable) return m.unit;
  }
  const engine::ExperimentInfo* info = engine::find_experiment(experiment);
  if (info == nullptr) return engine::unit::one;
  const auto found =
      std::ranges::find(info->observables, observable, &engine::ObservableInfo::name);
  return found != info->observables.end() ? found->unit : engine::unit::one;
}

engine::Unit parameter_unit(const calibrator::Calibration& calibration,
                            const engine::ParameterKey& key) {
  const auto& free = calibration.free;
  const auto given = std::ranges::find(free, key, &calibrator::FreeParameter::key);
  if (given != free.end()) return given->unit;
  const engine::ParameterInfo* info = engine::find_parameter(key.field);
  return info != nullptr ? info->field->unit : engine::unit::one;
}

}  // namespace repose::server
