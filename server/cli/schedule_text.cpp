#include "server/cli/schedule_text.hpp"

#include "engine/unit.hpp"
#include "server/cli/text_table.hpp"
#include "server/json/place.hpp"
#include "server/json/text.hpp"

namespace repose::server {

namespace {

/// A member of an own document as text; empty where it is null or missing.
std::string word(const Json& object, const char* member) {
  if (!object.is_object() || !object.contains(member)) return {};
  const Json& value = object[member];
  if (value.is_null()) return {};
  return value.is_string() ? value.get<std::string>() : to_text(value);
}

/// A time without its fraction of a second.
std::string moment(const Json& object, const char* member) {
  const std::string text = word(object, member);
  const std::size_t dot = text.find('.');
  return dot == std::string::npos ? text : text.substr(0, dot) + "Z";
}

Json member(const Json& object, const char* name) {
  return object.is_object() ? object.value(name, Json(nullptr)) : Json(nullptr);
}

std::string what_came_of(const Json& night) {
  const std::string outcome = word(night, "outcome");
  return outcome.empty() ? word(night, "state") : outcome;
}

std::string alarms_of(const Json& night) {
  std::string names;
  const Json drifting = member(member(night, "result"), "alarms");
  for (const Json& name : drifting) {
    names += (names.empty() ? "" : ", ") + name.get<std::string>();
  }
  return names;
}

std::string fit_text(const Json& fit) {
  if (!fit.is_object()) return {};
  TextTable table({"parameter", "best", "95 % interval", "unit"});
  for (const Json& parameter : fit.value("parameters", Json::array())) {
    std::string name = word(parameter, "field");
    std::string between;
    for (const Json& material : parameter.value("between", Json::array())) {
      between += (between.empty() ? ":" : "-") + material.get<std::string>();
    }
    const auto number = [](const Json& value) {
      return value.is_number() ? engine::short_number(value.get<double>()) : std::string("-");
    };
    const Json interval = member(parameter, "interval");
    table.row({name + between,
               number(member(parameter, "value")),
               interval.is_array() && interval.size() == 2
                   ? number(interval[0]) + " to " + number(interval[1])
                   : "-",
               word(parameter, "unit")});
  }
  return table.str();
}

}  // namespace

std::string print_schedule_text(std::string_view document) {
  const Json schedule = Json::parse(document, nullptr, false);
  const Json promoted = member(schedule, "promoted");
  const Json night = member(schedule, "last_night");
  std::string text = "schedule " + word(schedule, "id") + ": " + word(schedule, "name") + "\n";
  const auto line = [&](const std::string& name, const std::string& value) {
    if (!value.empty()) text += name + std::string(12 - name.size(), ' ') + value + "\n";
  };
  line("when", word(schedule, "cron") + " in " + word(schedule, "time_zone"));
  line("removed", moment(schedule, "removed_at"));
  line("next", moment(schedule, "next_at"));
  if (night.is_object()) {
    line("last night", moment(night, "planned_at") + ": " + what_came_of(night));
    line("because", word(member(night, "result"), "reason"));
    line("drifting", alarms_of(night));
  }
  if (promoted.is_object()) {
    line("in force",
         "calibration " + word(promoted, "calibration") + " since " +
             moment(promoted, "promoted_at") + ": " + word(promoted, "reason"));
    text += "\n" + fit_text(member(schedule, "fit"));
  } else {
    line("in force", "no fit yet");
  }
  return text;
}

std::string print_schedules_text(std::string_view document) {
  TextTable table({"name", "id", "when", "next", "last night", "in force"}, "lrlllr");
  const Json list = Json::parse(document, nullptr, false);
  for (const Json& schedule : list.value("items", Json::array())) {
    table.row({word(schedule, "name"),
               word(schedule, "id"),
               word(schedule, "cron") + " " + word(schedule, "time_zone"),
               moment(schedule, "next_at"),
               what_came_of(member(schedule, "last_night")),
               word(member(schedule, "promoted"), "calibration")});
  }
  return table.str();
}

std::string print_nights_text(std::string_view document) {
  TextTable table({"planned", "outcome", "calibration", "promoted", "drifting", "because"},
                  "llrlll");
  const Json list = Json::parse(document, nullptr, false);
  for (const Json& night : list.value("items", Json::array())) {
    const Json result = member(night, "result");
    const bool promoted = result.is_object() && result.value("promoted", false);
    table.row({moment(night, "planned_at"),
               what_came_of(night),
               word(night, "calibration"),
               promoted ? "yes" : "",
               alarms_of(night),
               word(result, "reason")});
  }
  return table.str();
}

}  // namespace repose::server
