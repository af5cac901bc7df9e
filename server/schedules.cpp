#include "server/schedules.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "db/schedule_store.hpp"
#include "server/json/labels.hpp"
#include "server/json/schedule_json.hpp"
#include "server/nightly/continuation.hpp"
#include "server/nightly/nights.hpp"

namespace repose::server {

using db::ScheduleStore;
using engine::Unexpected;

namespace {

constexpr std::int64_t second = 1'000'000;  // microseconds

/// The schedule, and that the calibration to start from is one that can be.
Answer<NightlySchedule> read(db::Store& store, std::string_view document) {
  if (auto labels = problems_of_schedule_labels(document); !labels.empty()) {
    return Unexpected{invalid("the schedule", std::move(labels))};
  }
  auto schedule = read_schedule(store, document);
  if (!schedule) return Unexpected{invalid("the schedule", schedule.error())};
  if (!schedule->start_from) return *std::move(schedule);
  const std::string found = std::to_string(*schedule->start_from);
  if (!published(store, *schedule->start_from)) {
    return Unexpected{invalid("the schedule",
                              {{"/start_from",
                                "there is no finished calibration " + found,
                                found,
                                "the number of a calibration that is done"}})};
  }
  return *std::move(schedule);
}

/// Whether both calibrate the same parameters by the same experiments, so that the fit of one can
/// stand for the other's.
bool same_search(const calibrator::Calibration& a, const calibrator::Calibration& b) {
  const auto question = [](const calibrator::Calibration& study) {
    std::set<std::string> experiments, parameters;
    for (const auto& measurement : study.measurements) {
      experiments.insert(std::string(measurement.experiment.name));
    }
    for (const auto& parameter : study.free) parameters.insert(engine::to_string(parameter.key));
    return std::pair(std::move(experiments), std::move(parameters));
  };
  return question(a) == question(b);
}

std::optional<std::int64_t> next_at(const db::ScheduleRecord& record, std::int64_t now) {
  if (record.removed_at) return std::nullopt;
  const auto timetable = parse_timetable(record.request);
  if (!timetable) return std::nullopt;
  const auto next =
      next_after(*timetable, std::chrono::sys_seconds(std::chrono::seconds(now / second)));
  if (!next) return std::nullopt;
  return next->time_since_epoch().count() * second;
}

ScheduleStanding standing(db::Store& store, const db::ScheduleRecord& record, std::int64_t now) {
  const ScheduleStore schedules(store);
  ScheduleStanding result{record, next_at(record, now), {}, {}, {}};
  const auto promotions = schedules.promotions(record.id);
  if (!promotions.empty()) {
    result.promoted = promotions.front();
    result.fit = store.calibration(promotions.front().calibration);
  }
  const auto nights = schedules.nights(record.id, 1, std::nullopt);
  if (!nights.empty()) result.last = nights.front();
  return result;
}

/// Whether the nights of both are at the same times.
bool same_times(const db::ScheduleRecord& before, const Timetable& now) {
  const auto timetable = parse_timetable(before.request);
  return timetable && timetable->cron == now.cron && timetable->zone.name() == now.zone.name() &&
         timetable->jitter == now.jitter;
}

/// Whether the calibration is one of the schedule's: a night's, or one promoted before.
bool belongs(const ScheduleStore& schedules, std::int64_t schedule, std::int64_t calibration) {
  const auto promotions = schedules.promotions(schedule);
  if (std::ranges::find(promotions, calibration, &db::PromotionRecord::calibration) !=
      promotions.end()) {
    return true;
  }
  const auto night = schedules.night_of(calibration);
  return night && night->schedule == schedule;
}

}  // namespace

std::vector<DriftFigure> drift_figures(const db::Store& store) {
  constexpr int look_back = 30;  // nights, of which those without new measurements found nothing
  const ScheduleStore schedules(store);
  std::vector<DriftFigure> figures;
  for (const auto& schedule : schedules.schedules()) {
    for (const auto& night : schedules.nights(schedule.id, look_back, std::nullopt)) {
      const auto followed = parse_followed(night.result.value_or(""));
      if (followed.empty()) continue;
      for (const Followed& quantity : followed) {
        figures.push_back({schedule.id, quantity.name, quantity.drift.level, quantity.drift.limit});
      }
      break;
    }
  }
  return figures;
}

Answer<std::string> add_schedule(db::Store& store, std::string_view document, std::int64_t now) {
  const auto read_one = read(store, document);
  if (!read_one) return Unexpected{read_one.error()};
  if (read_one->start_from &&
      !same_search(published(store, *read_one->start_from)->calibration, read_one->study)) {
    const std::string found = std::to_string(*read_one->start_from);
    return Unexpected{
        invalid("the schedule",
                {{"/start_from",
                  "calibration " + found + " has other experiments or other free parameters",
                  found,
                  "a calibration of the experiments and free parameters of the study"}})};
  }
  ScheduleStore schedules(store);
  const std::int64_t id = schedules.add(read_one->name, print_schedule(*read_one), now);
  if (read_one->start_from) {
    schedules.promote(id, *read_one->start_from, "the schedule starts from it", now);
  }
  return schedule(store, id, now);
}

Answer<std::string> replace_schedule(db::Store& store,
                                     std::int64_t id,
                                     std::string_view document,
                                     std::int64_t now) {
  const auto read_one = read(store, document);
  if (!read_one) return Unexpected{read_one.error()};
  ScheduleStore schedules(store);
  const auto before = schedules.schedule(id);
  if (!before || before->removed_at) return Unexpected{not_found("schedule", id)};
  if (same_times(*before, read_one->timetable)) keep_planned_night(store, *before, now);
  schedules.replace(id, read_one->name, print_schedule(*read_one), now);
  return schedule(store, id, now);
}

Answer<std::string> remove_schedule(db::Store& store, std::int64_t id, std::int64_t now) {
  if (!ScheduleStore(store).remove(id, now)) return Unexpected{not_found("schedule", id)};
  return schedule(store, id, now);
}

Answer<std::string> schedule(db::Store& store, std::int64_t id, std::int64_t now) {
  const auto record = ScheduleStore(store).schedule(id);
  if (!record) return Unexpected{not_found("schedule", id)};
  return print_standing(standing(store, *record, now), true);
}

std::string schedules(db::Store& store, std::int64_t now) {
  std::vector<ScheduleStanding> standings;
  for (const db::ScheduleRecord& record : ScheduleStore(store).schedules()) {
    standings.push_back(standing(store, record, now));
  }
  return print_standings(standings);
}

Answer<Page> nights(db::Store& store,
                    std::int64_t id,
                    int limit,
                    std::optional<std::int64_t> before) {
  const ScheduleStore schedules(store);
  if (!schedules.schedule(id)) return Unexpected{not_found("schedule", id)};
  return print_nights(schedules.nights(id, limit, before), limit);
}

Answer<std::string> promotions(db::Store& store, std::int64_t id) {
  const ScheduleStore schedules(store);
  if (!schedules.schedule(id)) return Unexpected{not_found("schedule", id)};
  return print_promotions(schedules.promotions(id));
}

Answer<std::string> promote(db::Store& store,
                            std::int64_t id,
                            std::string_view document,
                            std::int64_t now) {
  ScheduleStore schedules(store);
  if (!schedules.schedule(id)) return Unexpected{not_found("schedule", id)};
  const auto calibration = parse_promotion_request(document);
  if (!calibration) return Unexpected{invalid("the promotion", calibration.error())};
  const std::string name = "calibration " + std::to_string(*calibration);
  if (!belongs(schedules, id, *calibration)) {
    return Unexpected{Refusal{Refusal::Kind::wrong_state,
                              name + " is none of the schedule's: its nights and promotions name "
                                     "those that can be put in force",
                              {}}};
  }
  if (!published(store, *calibration)) {
    return Unexpected{Refusal{Refusal::Kind::wrong_state, name + " has no fit", {}}};
  }
  schedules.promote(id, *calibration, "put in force by hand", now);
  return schedule(store, id, now);
}

}  // namespace repose::server
