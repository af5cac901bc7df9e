#include "calibrator/measurement.hpp"

#include <algorithm>

#include "engine/catalogue.hpp"

namespace repose::calibrator {

bool is_same_question(const engine::Experiment& a, const engine::Experiment& b) {
  if (a.name != b.name) return false;
  if (a.settings == b.settings) return true;
  const engine::ExperimentInfo* info = engine::find_experiment(a.name);
  if (info == nullptr) return false;
  const auto declared = [&](const engine::Experiment& experiment) {
    return std::ranges::all_of(experiment.settings, [&](const auto& setting) {
      return std::ranges::count(info->settings, setting.first, &engine::FieldInfo::name) > 0;
    });
  };
  const auto same_at = [&](engine::Fidelity fidelity) {
    const auto resolved = [&](engine::Experiment experiment) {
      experiment.fidelity = fidelity;
      return engine::resolved_settings(*info, experiment);
    };
    return resolved(a) == resolved(b);
  };
  using enum engine::Fidelity;
  return declared(a) && declared(b) && same_at(draft) && same_at(standard) && same_at(paper);
}

bool is_same_quantity(const Measurement& a, const Measurement& b) {
  return a.observable == b.observable && is_same_question(a.experiment, b.experiment);
}

std::vector<std::span<const Measurement>> lines_of(std::span<const Measurement> measurements) {
  std::vector<std::span<const Measurement>> lines;
  for (std::size_t first = 0, end = 0; first < measurements.size(); first = end) {
    const int curve = measurements[first].curve;
    end = first + 1;
    while (curve > 0 && end < measurements.size() && measurements[end].curve == curve) ++end;
    lines.push_back(measurements.subspan(first, end - first));
  }
  return lines;
}

std::string setting_along(std::span<const Measurement> curve) {
  const auto& first = curve.front().experiment.settings;
  for (const Measurement& point : curve) {
    for (const auto& [name, value] : point.experiment.settings) {
      const auto other = first.find(name);
      if (other == first.end() || other->second != value) return name;
    }
  }
  return {};
}

}  // namespace repose::calibrator
