#include "server/report/lineage.hpp"

#include <algorithm>

#include "engine/catalogue.hpp"
#include "server/letters.hpp"
#include "server/report/label.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Measurement;

namespace {

template <class Naming>
std::vector<MeasurementGroup> grouped(const Calibration& calibration, const Naming& name_of) {
  std::vector<MeasurementGroup> groups;
  for (std::size_t i = 0; i < calibration.measurements.size(); ++i) {
    const std::string name = name_of(calibration.measurements[i]);
    auto group = std::ranges::find(groups, name, &MeasurementGroup::name);
    if (group == groups.end()) group = groups.insert(groups.end(), {name, {}});
    group->measurements.push_back(i);
  }
  return groups;
}

}  // namespace

std::string model_name(const Generation& generation) {
  const auto& extends = generation.calibration().extends;
  if (!extends) return "base model";
  const engine::EffectInfo* effect = engine::find_effect(extends->effect);
  if (effect != nullptr) return "+ " + lower_first(std::string(effect->text.title));
  std::string name = extends->effect;
  std::ranges::replace(name, '_', ' ');
  return "+ " + name;
}

std::vector<MeasurementGroup> groups_by_observable(const Calibration& calibration) {
  return grouped(calibration, measurement_label);
}

std::vector<MeasurementGroup> groups_by_experiment(const Calibration& calibration) {
  return grouped(calibration, [](const Measurement& measurement) {
    std::string name = measurement.experiment.name;
    std::ranges::replace(name, '_', ' ');
    return name;
  });
}

std::string place_label(const Calibration& calibration, const Measurement& measurement) {
  std::string label = distinction_label(calibration.measurements, measurement);
  return label.empty() ? "as usual" : label;
}

const calibrator::ComparedMeasurement* row_of(const Generation& generation,
                                              std::size_t measurement) {
  const auto& rows = generation.comparison.rows;
  const auto found =
      std::ranges::find(rows, measurement, &calibrator::ComparedMeasurement::measurement);
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace repose::server
