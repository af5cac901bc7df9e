/// Lineage: models of which each adds an effect to the one before, as their report needs them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calibrator/comparison.hpp"
#include "calibrator/diagnosis/diagnosis.hpp"
#include "server/json/report_json.hpp"

namespace repose::server {

/// One model: a finished calibration, how it compares, and what its last diagnosis said.
struct Generation {
  CalibrationDocument document;  ///< with calibration and fit
  calibrator::Comparison comparison;
  std::optional<calibrator::Diagnosis> diagnosis;
  std::int64_t diagnosis_id = 0;

  [[nodiscard]] const calibrator::Calibration& calibration() const { return *document.calibration; }
  [[nodiscard]] const calibrator::Fit& fit() const { return *document.fit; }
};

/// The first is the base, of which the measurements are those of all.
using Lineage = std::vector<Generation>;

/// "base model", "+ air drag"
std::string model_name(const Generation& generation);

/// Measurements that are drawn together, by their place in the calibration.
struct MeasurementGroup {
  std::string name;
  std::vector<std::size_t> measurements;
};
std::vector<MeasurementGroup> groups_by_observable(const calibrator::Calibration& calibration);
std::vector<MeasurementGroup> groups_by_experiment(const calibrator::Calibration& calibration);

/// What tells a measurement from the others of its group: its settings, or that it has the usual ones.
std::string place_label(const calibrator::Calibration& calibration,
                        const calibrator::Measurement& measurement);

/// The comparison's row of that measurement; nothing where it was not predicted.
const calibrator::ComparedMeasurement* row_of(const Generation& generation,
                                              std::size_t measurement);

}  // namespace repose::server
