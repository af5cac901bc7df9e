#include "calibrator/measurement.hpp"

namespace repose::calibrator {

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
