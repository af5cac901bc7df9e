/// ScheduleStore: the verbs for schedules, their nights and their promotions. As the store's: each
/// is one transaction, from any thread. Times are microseconds since 1970 UTC.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "db/store.hpp"

namespace repose::db {

struct ScheduleRecord {
  std::int64_t id = 0;
  std::string name;
  std::int64_t created_at = 0;
  std::optional<std::int64_t> replaced_at;
  std::optional<std::int64_t> removed_at;
  std::string request;  ///< document
};

struct NightRecord {
  std::int64_t id = 0;
  std::int64_t schedule = 0;
  std::int64_t planned_at = 0;
  std::int64_t started_at = 0;
  std::optional<std::int64_t> finished_at;
  std::string state;  ///< running, done, failed, skipped
  std::optional<std::string> outcome;
  std::optional<std::int64_t> incumbent;    ///< calibration that was promoted when it began
  std::optional<std::int64_t> calibration;  ///< that ran
  std::optional<std::string> continues;     ///< document: calibrations whose runs it knew
  std::optional<std::int64_t> diagnosis;
  std::optional<std::string> result;  ///< document
};

/// What a night came to.
struct NightEnd {
  std::string state;
  std::optional<std::string> outcome = {};
  std::optional<std::int64_t> diagnosis = {};
  std::string result = {};
  std::string promotion = {};  ///< why its calibration is promoted; empty: it is not
};

struct PromotionRecord {
  std::int64_t id = 0;
  std::int64_t schedule = 0;
  std::int64_t calibration = 0;
  std::optional<std::int64_t> night;
  std::int64_t promoted_at = 0;
  std::string reason;
};

class ScheduleStore {
 public:
  explicit ScheduleStore(const Store& store) : store_(store) {}

  std::int64_t add(const std::string& name, const std::string& request, std::int64_t now);
  /// False where there is none, or it was removed.
  bool replace(std::int64_t id,
               const std::string& name,
               const std::string& request,
               std::int64_t now);
  bool remove(std::int64_t id, std::int64_t now);
  [[nodiscard]] std::optional<ScheduleRecord> schedule(std::int64_t id) const;
  [[nodiscard]] std::vector<ScheduleRecord> schedules() const;  ///< those not removed

  /// A night that runs now; nothing where that night is there already.
  std::optional<std::int64_t> begin_night(std::int64_t schedule,
                                          std::int64_t planned_at,
                                          std::int64_t now);
  void set_night_calibration(std::int64_t night,
                             std::int64_t calibration,
                             const std::optional<std::int64_t>& incumbent,
                             const std::optional<std::string>& continues);
  /// running -> done, failed or skipped, with its promotion; false where it was final already.
  bool end_night(std::int64_t night, const NightEnd& end, std::int64_t now);
  [[nodiscard]] std::optional<NightRecord> night(std::int64_t id) const;
  /// The night that ran a calibration, if any.
  [[nodiscard]] std::optional<NightRecord> night_of(std::int64_t calibration) const;
  [[nodiscard]] std::vector<NightRecord> running_nights() const;  ///< oldest first
  /// Newest first, ids below `before` where given.
  [[nodiscard]] std::vector<NightRecord> nights(std::int64_t schedule,
                                                int limit,
                                                std::optional<std::int64_t> before) const;

  void promote(std::int64_t schedule,
               std::int64_t calibration,
               const std::string& reason,
               std::int64_t now);
  /// Newest first: the first one is in force.
  [[nodiscard]] std::vector<PromotionRecord> promotions(std::int64_t schedule) const;
  /// Which calibrations' fits are in force, each with the schedules (those not removed) that have
  /// it so.
  [[nodiscard]] std::map<std::int64_t, std::vector<std::int64_t>> in_force() const;

 private:
  [[nodiscard]] std::vector<NightRecord> select_nights(std::string_view rest,
                                                       std::optional<std::int64_t> first,
                                                       std::optional<std::int64_t> second,
                                                       int limit) const;
  const Store& store_;
};

}  // namespace repose::db
