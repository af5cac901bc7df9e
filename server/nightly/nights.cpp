#include "server/nightly/nights.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "db/measurement_store.hpp"
#include "db/schedule_store.hpp"
#include "engine/evaluate.hpp"
#include "engine/random.hpp"
#include "server/access/secret.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/schedule_json.hpp"
#include "server/measurements.hpp"
#include "server/nightly/conclusion.hpp"
#include "server/nightly/continuation.hpp"

namespace repose::server {

using calibrator::Calibration;
using db::NightRecord;
using db::ScheduleRecord;
using db::ScheduleStore;

namespace {

constexpr std::int64_t second = 1'000'000;  // microseconds
constexpr int looked_back = 400;            // nights in which the last ones of a kind are sought
constexpr std::size_t most_continued = 30;  // searches whose runs are known from the start

std::chrono::sys_seconds instant(std::int64_t microseconds) {
  return std::chrono::sys_seconds(std::chrono::seconds(microseconds / second));
}

std::int64_t microseconds_of(std::chrono::sys_seconds time) {
  return time.time_since_epoch().count() * second;
}

/// Seeds that no other night of any schedule has used, so that each has a calibration of its own;
/// 53 bits, so that they survive as a JSON number.
std::uint64_t seed_of_night(const Calibration& study, const NightRecord& night) {
  const auto draw = [](std::uint64_t seed, std::int64_t index) {
    return engine::Random(seed, engine::Purpose::trial, static_cast<std::uint64_t>(index)).bits();
  };
  return draw(draw(study.seed, night.schedule), night.planned_at) >> 11U;
}

/// What a study asks, whatever its seed.
std::string question_of(Calibration study) {
  study.seed = 0;
  return print_calibration(study);
}

/// The calibration that the last night was about: nothing new since then is nothing to do.
std::optional<std::int64_t> last_worked(const std::vector<NightRecord>& nights) {
  for (const NightRecord& night : nights) {
    if (night.state == "done" && night.calibration) return night.calibration;
  }
  return std::nullopt;
}

bool is_unchanged(const db::Store& store, const Calibration& study, std::int64_t before) {
  const auto record = store.calibration(before);
  const auto asked = record ? parse_calibration(record->request) : engine::Unexpected{Problems{}};
  if (!asked || question_of(*asked) != question_of(study)) return false;
  const auto used = store.used(before, 1, std::nullopt);
  return !used.empty() && used.front().evaluation.engine_version == engine::version();
}

/// The searches of the schedule so far, oldest first, the promoted one among them.
std::vector<std::int64_t> searches(const std::vector<NightRecord>& nights, std::int64_t promoted) {
  std::vector<std::int64_t> ids;
  for (const NightRecord& night : nights) {
    if (ids.size() + 1 >= most_continued) break;
    const bool searched = night.state == "done" && night.calibration && night.outcome != "kept";
    if (searched && night.calibration != promoted) ids.push_back(*night.calibration);
  }
  ids.push_back(promoted);
  std::ranges::sort(ids);
  return ids;
}

void end(ScheduleStore& schedules,
         std::int64_t night,
         db::NightEnd result,
         const std::string& reason,
         std::int64_t now) {
  NightReport report;
  report.reason = reason;
  result.result = print_night_report({}, report);
  schedules.end_night(night, result, now);
}

/// Where the measurements are from, so that the fit is found by its material.
db::SourceRecord source_of(db::Store& store, const NightlySchedule& schedule) {
  const auto submission = resolve_submission(store, schedule.submission);
  return submission ? submission->source : db::SourceRecord{};
}

/// The night's calibration, queued; or nothing, and the night is over.
std::optional<std::int64_t> prepare(db::Store& store,
                                    const ScheduleRecord& record,
                                    const NightRecord& night,
                                    std::int64_t now) {
  ScheduleStore schedules(store);
  const auto schedule = read_schedule(store, record.request);
  if (!schedule) {
    end(schedules,
        night.id,
        {.state = "failed"},
        "the schedule cannot be read any more: " + schedule.error().front().message,
        now);
    return std::nullopt;
  }
  Calibration study = schedule->study;
  const auto nights = schedules.nights(record.id, looked_back, std::nullopt);
  const auto promotions = schedules.promotions(record.id);
  std::optional<std::int64_t> promoted;
  if (!promotions.empty()) promoted = promotions.front().calibration;
  const auto before = last_worked(nights) ? last_worked(nights) : promoted;
  if (before && is_unchanged(store, study, *before)) {
    end(schedules,
        night.id,
        {.state = "done", .outcome = "unchanged"},
        "no measurement has changed since calibration " + std::to_string(*before),
        now);
    return std::nullopt;
  }
  study.seed = seed_of_night(study, night);
  const std::string request = print_calibration(study);
  const auto queued = store.unfinished(digest(request));
  const std::int64_t id =
      queued ? queued->id
             : db::MeasurementStore(store).add_calibration(
                   study.name, request, digest(request), source_of(store, *schedule), now);
  std::optional<std::string> continues;
  if (promoted) continues = print_ids(searches(nights, *promoted));
  schedules.set_night_calibration(night.id, id, promoted, continues);
  return id;
}

/// When a night is planned that is to begin now.
struct Beginning {
  std::int64_t planned_at = 0;
  bool too_late = false;
};

/// The times of a schedule, which can be read even where its study cannot any more: then the night
/// comes, and says so.
Timetable times_of(const ScheduleRecord& record) {
  auto timetable = parse_timetable(record.request);
  if (timetable) return *std::move(timetable);
  throw std::runtime_error("its times cannot be read any more: " +
                           timetable.error().front().message);
}

std::optional<Beginning> beginning(const ScheduleStore& schedules,
                                   const ScheduleRecord& record,
                                   const Timetable& timetable,
                                   std::int64_t now) {
  const auto last = schedules.nights(record.id, 1, std::nullopt);
  const std::int64_t since = std::max({record.created_at,
                                       record.replaced_at.value_or(0),
                                       last.empty() ? 0 : last.front().planned_at});
  const auto night = due(timetable, record.id, instant(since), instant(now));
  if (!night) return std::nullopt;
  return Beginning{microseconds_of(night->planned), night->too_late};
}

/// The row of a night that runs now; nothing where that night has been, or is skipped.
std::optional<std::int64_t> open_night(ScheduleStore& schedules,
                                       std::int64_t schedule,
                                       const Beginning& night,
                                       std::int64_t now) {
  const auto running = schedules.running_nights();
  const bool overlaps =
      std::ranges::find(running, schedule, &NightRecord::schedule) != running.end();
  const auto id = schedules.begin_night(schedule, night.planned_at, now);
  if (!id || (!night.too_late && !overlaps)) return id;
  end(schedules,
      *id,
      {.state = "skipped"},
      overlaps ? "the night before is still running" : "it was missed, and is too late to catch up",
      now);
  return std::nullopt;
}

std::optional<std::int64_t> begin_night(db::Store& store,
                                        const ScheduleRecord& record,
                                        Begin which,
                                        std::int64_t now) {
  ScheduleStore schedules(store);
  const auto night = which == Begin::all ? std::optional(Beginning{now})
                                         : beginning(schedules, record, times_of(record), now);
  if (!night) return std::nullopt;
  const auto id = open_night(schedules, record.id, *night, now);
  if (!id) return std::nullopt;
  return prepare(store, record, *schedules.night(*id), now);
}

}  // namespace

void keep_planned_night(db::Store& store, const ScheduleRecord& record, std::int64_t now) {
  ScheduleStore schedules(store);
  Timetable at_once = times_of(record);
  at_once.catch_up += at_once.jitter;
  at_once.jitter = std::chrono::seconds(0);
  if (const auto night = beginning(schedules, record, at_once, now)) {
    open_night(schedules, record.id, *night, now);
  }
}

engine::Result<NightlySchedule, Problems> read_schedule(db::Store& store,
                                                        std::string_view document) {
  return parse_schedule(document,
                        [&](std::string_view text) -> engine::Result<std::string, Problems> {
                          auto submission = resolve_submission(store, text);
                          if (submission) return submission->study;
                          return engine::Unexpected{submission.error().problems};
                        });
}

std::vector<std::int64_t> begin_nights(db::Store& store,
                                       Begin which,
                                       std::int64_t now,
                                       FailureLog& failures) {
  ScheduleStore schedules(store);
  std::vector<std::int64_t> calibrations;
  const auto add = [&](const std::optional<std::int64_t>& id) {
    if (id && !store.calibration(*id)->finished_at) calibrations.push_back(*id);
  };
  for (const NightRecord& night : schedules.running_nights()) {
    failures.run("the preparation of night " + std::to_string(night.id), [&] {
      add(night.calibration ? night.calibration
                            : prepare(store, *schedules.schedule(night.schedule), night, now));
    });
  }
  for (const ScheduleRecord& record : schedules.schedules()) {
    failures.run("schedule " + std::to_string(record.id),
                 [&] { add(begin_night(store, record, which, now)); });
  }
  return calibrations;
}

std::vector<std::int64_t> end_nights(db::Store& store,
                                     const WorkerOptions& options,
                                     const std::stop_token& stop,
                                     std::int64_t now,
                                     FailureLog& failures) {
  ScheduleStore schedules(store);
  std::vector<std::int64_t> diagnoses;
  for (const NightRecord& night : schedules.running_nights()) {
    failures.run("the end of night " + std::to_string(night.id), [&] {
      if (!night.calibration || !store.calibration(*night.calibration)->finished_at) return;
      const Conclusion conclusion = conclude(store, options, night, stop);
      if (conclusion.end) schedules.end_night(night.id, *conclusion.end, now);
      if (conclusion.diagnosis) diagnoses.push_back(*conclusion.diagnosis);
    });
  }
  return diagnoses;
}

}  // namespace repose::server
