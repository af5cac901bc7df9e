/// MeasurementStore: sets of measurements by name and version, and what calibrations took from
/// them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "db/store.hpp"

namespace repose::db {

struct MeasurementSetRecord {
  std::int64_t id = 0;
  std::string name;
  std::int64_t version = 0;  ///< from 1
  std::string material;
  std::int64_t created_at = 0;
  std::string measurements;  ///< document: an array
};

/// What a calibration is of.
struct SourceRecord {
  std::optional<std::string> material;
  std::optional<std::int64_t> set;  ///< id
};

/// A finished calibration with its fit, and what it is of.
struct FitRecord {
  CalibrationRecord calibration;
  std::optional<std::string> material;
  std::optional<std::string> set;  ///< name
  std::optional<std::int64_t> version;
};

/// Which fits are wanted: those not given do not matter.
struct FitFilter {
  std::optional<std::string> material = {};
  std::optional<std::string> name = {};  ///< of the study
  std::optional<std::int64_t> before = {};
};

class MeasurementStore {
 public:
  explicit MeasurementStore(Store& store) : store_(store) {}

  /// Adds a version; the newest one where it holds the same already.
  MeasurementSetRecord put(const std::string& name,
                           const std::string& material,
                           const std::string& measurements,
                           std::int64_t now);
  /// The newest version where none is given.
  [[nodiscard]] std::optional<MeasurementSetRecord> find(
      const std::string& name, const std::optional<std::int64_t>& version) const;
  /// The newest version of each, by name, names after `after`; without measurements.
  [[nodiscard]] std::vector<MeasurementSetRecord> list(
      int limit, const std::optional<std::string>& after) const;

  /// As Store::add_calibration(), with what it is of.
  std::int64_t add_calibration(const std::string& name,
                               const std::string& request,
                               const std::string& digest,
                               const SourceRecord& source,
                               std::int64_t now);
  /// What a calibration is of; nothing of either where nobody said.
  [[nodiscard]] SourceRecord source(std::int64_t calibration) const;
  /// Without measurements.
  [[nodiscard]] std::optional<MeasurementSetRecord> set(std::int64_t id) const;
  /// Of finished calibrations, newest first.
  [[nodiscard]] std::vector<FitRecord> fits(const FitFilter& filter, int limit) const;
  /// The smallest misfit of every study's name and material, by name.
  [[nodiscard]] std::vector<FitRecord> best_fits(const FitFilter& filter) const;

 private:
  [[nodiscard]] std::vector<FitRecord> select_fits(std::string_view rest,
                                                   const FitFilter& filter,
                                                   int limit) const;
  Store& store_;
};

}  // namespace repose::db
