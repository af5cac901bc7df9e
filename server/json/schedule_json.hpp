/// Schedules, their nights and promotions: documents (schemas/schedule.schema.json, answers) <->
/// what the service works with.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"
#include "db/schedule_store.hpp"
#include "engine/result.hpp"
#include "server/json/page.hpp"
#include "server/json/problem.hpp"
#include "server/nightly/drift.hpp"
#include "server/nightly/timetable.hpp"

namespace repose::server {

struct NightlySchedule {
  std::string name = {};
  std::string cron = {};
  Timetable timetable;
  std::optional<std::int64_t> start_from = {};
  std::string submission = {};         ///< the study as it was sent: it may name a measurement set
  calibrator::Calibration study = {};  ///< with the measurements of that set, as it is now
};

/// Puts the measurements in the place of a set's name.
using Resolve = std::function<engine::Result<std::string, Problems>(std::string_view submission)>;

/// All problems of the text at once, or the schedule.
engine::Result<NightlySchedule, Problems> parse_schedule(std::string_view text,
                                                         const Resolve& resolve);

/// When the nights of a schedule are, whatever has become of its study.
engine::Result<Timetable, Problems> parse_timetable(std::string_view text);

/// The document that reads back as this schedule.
std::string print_schedule(const NightlySchedule& schedule);

/// A quantity that is followed from night to night.
struct Followed {
  std::string name;  ///< "sliding_friction.coefficient:grain-grain", "kettle.bulk_density"
  Estimate estimate;
  Drift drift;  ///< after that estimate
};

/// A measurement of tonight that the last night had otherwise, or not at all.
struct ChangedMeasurement {
  std::size_t measurement = 0;        ///< index into the study's
  std::optional<double> before = {};  ///< SI
};

/// What a night found: its result document.
struct NightReport {
  std::vector<ChangedMeasurement> changed;
  std::optional<bool> incumbent_held;  ///< nothing: there was none to check
  std::vector<Followed> followed;
  std::vector<std::string> alarms;  ///< names of those that alarm
  bool promoted = false;
  std::string reason;  ///< a sentence for people
};

std::string print_night_report(const calibrator::Calibration& study, const NightReport& report);

/// The quantities that a night's result followed.
std::vector<Followed> parse_followed(std::string_view report);

/// {"items":[{"id","schedule","planned_at","state","outcome",...,"result"}],"next"}
Page print_nights(const std::vector<db::NightRecord>& nights, int limit);
/// {"items"}
std::string print_promotions(const std::vector<db::PromotionRecord>& promotions);

/// A schedule with where it stands.
struct ScheduleStanding {
  db::ScheduleRecord record;
  std::optional<std::int64_t> next_at;  ///< microseconds; nothing: never
  std::optional<db::PromotionRecord> promoted;
  std::optional<db::CalibrationRecord> fit;  ///< the promoted calibration
  std::optional<db::NightRecord> last;
};
std::string print_standing(const ScheduleStanding& standing, bool whole);
std::string print_standings(const std::vector<ScheduleStanding>& standings);

/// {"calibration": N} -> N.
engine::Result<std::int64_t, Problems> parse_promotion_request(std::string_view text);

/// [1, 2, 3]
std::string print_ids(const std::vector<std::int64_t>& ids);
std::vector<std::int64_t> parse_ids(std::string_view text);

/// The name under which a measurement is followed: its observable and, where they differ from the
/// usual, its settings.
std::string name_of(const calibrator::Measurement& measurement);

}  // namespace repose::server
