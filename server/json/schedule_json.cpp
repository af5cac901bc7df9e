#include "server/json/schedule_json.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "engine/unit.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/codec.hpp"
#include "server/json/place.hpp"
#include "server/json/text.hpp"

namespace repose::server {

namespace {

constexpr std::int64_t largest_id = std::numeric_limits<std::int64_t>::max();

void read_timetable(Members& members, NightlySchedule& schedule) {
  const Place cron = members.required("cron", "five fields, such as \"30 2 * * *\"");
  const Place zone = members.required("time_zone", "an IANA name, such as \"Europe/Berlin\"");
  const Place jitter = members.optional("jitter_minutes");
  const Place catch_up = members.optional("catch_up_hours");
  if (const auto text = cron.exists() ? cron.text(1000) : std::nullopt) {
    auto parsed = parse_cron(*text);
    if (!parsed) {
      cron.complain(parsed.error(), "a cron expression");
    } else if (!first_from(*parsed, {})) {
      cron.complain("there is no such day in any year", "a day that comes");
    } else {
      schedule.timetable.cron = *parsed;
      schedule.cron = *text;
    }
  }
  if (const auto name = zone.exists() ? zone.text(100) : std::nullopt) {
    if (const auto found = TimeZone::find(*name)) {
      schedule.timetable.zone = *found;
    } else {
      zone.complain("the time zone database has no \"" + *name + "\"",
                    "an IANA name, such as Europe/Berlin, America/Chicago or UTC");
    }
  }
  if (jitter.exists()) {
    schedule.timetable.jitter = std::chrono::minutes(jitter.whole(0, 1440).value_or(0));
  }
  if (catch_up.exists()) {
    schedule.timetable.catch_up = std::chrono::hours(catch_up.whole(0, 8760).value_or(12));
  }
}

/// The study that stands there, its problems where they stand in the whole document.
void read_study(const Place& place, const Resolve& resolve, NightlySchedule& schedule) {
  if (!place.exists()) return;
  schedule.submission = to_text(place.json());
  const auto resolved = resolve(schedule.submission);
  auto study = resolved ? parse_calibration(*resolved) : engine::Unexpected{resolved.error()};
  if (study) {
    schedule.study = *std::move(study);
    if (schedule.study.extends) {
      place.complain("a scheduled study begins by itself",
                     "a study without \"extends\"; \"start_from\" names the calibration to start "
                     "from");
    }
    return;
  }
  for (Problem problem : study.error()) {
    problem.pointer.insert(0, place.pointer());
    place.problems().add(std::move(problem));
  }
}

Json print_followed(const Followed& followed) {
  const Drift& drift = followed.drift;
  return {{"name", followed.name},
          {"value", number_or_null(followed.estimate.value)},
          {"standard_error", number_or_null(followed.estimate.standard_error)},
          {"points", drift.points},
          {"centre", drift.centre},
          {"precision", drift.precision},
          {"level", drift.level},
          {"limit", drift.limit},
          {"alarm", drift.alarm}};
}

Json night_json(const db::NightRecord& night) {
  return {{"id", night.id},
          {"schedule", night.schedule},
          {"planned_at", print_time(night.planned_at)},
          {"started_at", print_time(night.started_at)},
          {"finished_at", time_or_null(night.finished_at)},
          {"state", night.state},
          {"outcome", night.outcome ? Json(*night.outcome) : Json(nullptr)},
          {"incumbent", night.incumbent ? Json(*night.incumbent) : Json(nullptr)},
          {"calibration", night.calibration ? Json(*night.calibration) : Json(nullptr)},
          {"diagnosis", night.diagnosis ? Json(*night.diagnosis) : Json(nullptr)},
          {"result", document_or_null(night.result)}};
}

Json promotion_json(const db::PromotionRecord& promotion) {
  return {{"calibration", promotion.calibration},
          {"night", promotion.night ? Json(*promotion.night) : Json(nullptr)},
          {"promoted_at", print_time(promotion.promoted_at)},
          {"reason", promotion.reason}};
}

Json standing_json(const ScheduleStanding& standing, bool whole) {
  Json json = document_or_null(standing.record.request);
  if (!whole) json.erase("study");
  json["id"] = standing.record.id;
  json["created_at"] = print_time(standing.record.created_at);
  json["replaced_at"] = time_or_null(standing.record.replaced_at);
  json["removed_at"] = time_or_null(standing.record.removed_at);
  json["next_at"] = time_or_null(standing.next_at);
  json["promoted"] = standing.promoted ? promotion_json(*standing.promoted) : Json(nullptr);
  json["last_night"] = standing.last ? night_json(*standing.last) : Json(nullptr);
  if (whole) json["fit"] = standing.fit ? document_or_null(standing.fit->fit) : Json(nullptr);
  return json;
}

}  // namespace

engine::Result<NightlySchedule, Problems> parse_schedule(std::string_view text,
                                                         const Resolve& resolve) {
  ProblemList problems;
  const auto json = parse_text(text, {}, problems);
  if (!json) return engine::Unexpected{problems.all()};
  const Place whole(&*json, "", problems);
  if (!json->is_object()) {
    whole.complain("a schedule is an object", "an object");
    return engine::Unexpected{problems.all()};
  }
  NightlySchedule schedule{.timetable = {.cron = {}, .zone = *TimeZone::find("UTC")}};
  Members members(whole);
  const Place name = members.required("name", "a few words");
  if (const auto words = name.exists() ? name.text(200) : std::nullopt) {
    if (words->empty()) name.complain("a name is not empty", "a few words");
    schedule.name = *words;
  }
  read_timetable(members, schedule);
  const Place start_from = members.optional("start_from");
  if (start_from.exists()) schedule.start_from = start_from.whole(1, largest_id);
  read_study(members.required("study", "a study document"), resolve, schedule);
  members.no_others();
  if (!problems.empty()) return engine::Unexpected{problems.all()};
  return schedule;
}

engine::Result<Timetable, Problems> parse_timetable(std::string_view text) {
  ProblemList problems;
  const auto json = parse_text(text, {}, problems);
  if (!json) return engine::Unexpected{problems.all()};
  NightlySchedule schedule{.timetable = {.cron = {}, .zone = *TimeZone::find("UTC")}};
  Members members(Place(&*json, "", problems));
  read_timetable(members, schedule);
  if (!problems.empty()) return engine::Unexpected{problems.all()};
  return schedule.timetable;
}

std::string print_schedule(const NightlySchedule& schedule) {
  Json json{{"name", schedule.name},
            {"cron", schedule.cron},
            {"time_zone", schedule.timetable.zone.name()},
            {"jitter_minutes",
             std::chrono::duration_cast<std::chrono::minutes>(schedule.timetable.jitter).count()},
            {"catch_up_hours",
             std::chrono::duration_cast<std::chrono::hours>(schedule.timetable.catch_up).count()}};
  if (schedule.start_from) json["start_from"] = *schedule.start_from;
  json["study"] = Json::parse(schedule.submission);
  return to_text(json);
}

std::string print_ids(const std::vector<std::int64_t>& ids) { return to_text(Json(ids)); }

std::vector<std::int64_t> parse_ids(std::string_view text) {
  std::vector<std::int64_t> ids;
  for (const Json& id : Json::parse(text, nullptr, false)) {
    if (id.is_number_integer()) ids.push_back(id.get<std::int64_t>());
  }
  return ids;
}

std::string name_of(const calibrator::Measurement& measurement) {
  std::string name = measurement.experiment.name + "." + measurement.observable;
  for (const auto& [setting, value] : measurement.experiment.settings) {
    name += " " + setting + "=" + engine::short_number(value);
  }
  return name;
}

std::string print_night_report(const calibrator::Calibration& study, const NightReport& report) {
  Json changed = Json::array();
  for (const ChangedMeasurement& change : report.changed) {
    const calibrator::Measurement& now = study.measurements[change.measurement];
    changed.push_back(
        {{"measurement", name_of(now)},
         {"before", change.before ? in_unit(*change.before, now.unit) : Json(nullptr)},
         {"now", in_unit(now.value, now.unit)},
         {"unit", now.unit.symbol}});
  }
  Json followed = Json::array();
  for (const Followed& quantity : report.followed) followed.push_back(print_followed(quantity));
  return to_text(
      Json{{"reason", report.reason},
           {"changed", std::move(changed)},
           {"incumbent_held", report.incumbent_held ? Json(*report.incumbent_held) : nullptr},
           {"promoted", report.promoted},
           {"alarms", report.alarms},
           {"followed", std::move(followed)}});
}

std::vector<Followed> parse_followed(std::string_view report) {
  std::vector<Followed> result;
  const Json json = Json::parse(report, nullptr, false);
  if (!json.is_object()) return result;
  for (const Json& item : json.value("followed", Json::array())) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const auto number = [&](const char* member) {
      return item.contains(member) && item[member].is_number() ? item[member].get<double>()
                                                               : unknown;
    };
    result.push_back({item.value("name", ""),
                      {number("value"), number("standard_error")},
                      {.points = item.value("points", 0),
                       .centre = number("centre"),
                       .precision = number("precision"),
                       .level = number("level"),
                       .limit = number("limit"),
                       .alarm = item.value("alarm", false)}});
  }
  return result;
}

Page print_nights(const std::vector<db::NightRecord>& nights, int limit) {
  Json items = Json::array();
  for (const db::NightRecord& night : nights) items.push_back(night_json(night));
  return print_page(std::move(items), limit, nights.empty() ? Json() : Json(nights.back().id));
}

std::string print_promotions(const std::vector<db::PromotionRecord>& promotions) {
  Json items = Json::array();
  for (const db::PromotionRecord& promotion : promotions)
    items.push_back(promotion_json(promotion));
  return to_text(Json{{"items", std::move(items)}});
}

std::string print_standing(const ScheduleStanding& standing, bool whole) {
  return to_text(standing_json(standing, whole));
}

std::string print_standings(const std::vector<ScheduleStanding>& standings) {
  Json items = Json::array();
  for (const ScheduleStanding& standing : standings)
    items.push_back(standing_json(standing, false));
  return to_text(Json{{"items", std::move(items)}});
}

engine::Result<std::int64_t, Problems> parse_promotion_request(std::string_view text) {
  ProblemList problems;
  const auto json = parse_text(text, {}, problems);
  if (!json) return engine::Unexpected{problems.all()};
  Members members(Place(&*json, "", problems));
  const Place calibration = members.required("calibration", "the number of a calibration");
  members.no_others();
  const auto id = calibration.exists() ? calibration.whole(1, largest_id) : std::nullopt;
  if (!problems.empty() || !id) return engine::Unexpected{problems.all()};
  return *id;
}

}  // namespace repose::server
