/// EventStore: what happened, read in order. Written by the changes themselves: see the migration.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "db/store.hpp"

namespace repose::db {

struct EventRecord {
  std::int64_t id = 0;
  std::int64_t created_at = 0;  ///< microseconds since 1970 UTC
  std::string kind;             ///< calibration.done, diagnosis.running, ...
  std::optional<std::int64_t> calibration, diagnosis, schedule, night;
  std::optional<std::string> name;  ///< of the study
  std::optional<double> misfit;
  std::optional<std::string> error;
  std::optional<std::string> detail;  ///< document: the progress, or what a night came to
};

class EventStore {
 public:
  explicit EventStore(const Store& store) : store_(store) {}

  /// Oldest first, numbers above `after`; of one calibration, or of all.
  [[nodiscard]] std::vector<EventRecord> events(const std::optional<std::int64_t>& calibration,
                                                std::int64_t after,
                                                int limit) const;
  /// The number of the last event; 0 where there is none.
  [[nodiscard]] std::int64_t newest() const;
  /// How many nights have told of a quantity that drifts.
  [[nodiscard]] std::int64_t drift_alarms() const;

 private:
  const Store& store_;
};

}  // namespace repose::db
