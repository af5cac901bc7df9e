#include "server/json/event_json.hpp"

#include <utility>

#include "server/json/text.hpp"

namespace repose::server {

namespace {

/// What the event says beside its number and kind.
Json data_of(const db::EventRecord& event) {
  Json data;
  data["calibration"] = event.calibration ? Json(*event.calibration) : Json(nullptr);
  if (event.diagnosis) data["diagnosis"] = *event.diagnosis;
  if (event.schedule) data["schedule"] = *event.schedule;
  if (event.night) data["night"] = *event.night;
  if (event.name) data["name"] = *event.name;
  if (event.misfit) data["misfit"] = number_or_null(*event.misfit);
  if (event.error) data["error"] = *event.error;
  if (event.detail) {
    const char* detail = event.kind == "calibration.progress" ? "progress" : "result";
    data[detail] = Json::parse(*event.detail, nullptr, false);
  }
  return data;
}

}  // namespace

Page print_events(const std::vector<db::EventRecord>& events, int limit) {
  Json items = Json::array();
  for (const auto& event : events) {
    Json item;
    item["id"] = event.id;
    item["created_at"] = print_time(event.created_at);
    item["kind"] = event.kind;
    item["data"] = data_of(event);
    items.push_back(std::move(item));
  }
  return print_page(std::move(items), limit, events.empty() ? Json() : Json(events.back().id));
}

std::string print_event_data(const db::EventRecord& event) { return to_text(data_of(event)); }

std::string print_event_stream(const std::vector<db::EventRecord>& events) {
  std::string text;
  for (const auto& event : events) {
    text += "id: " + std::to_string(event.id) + "\nevent: " + event.kind +
            "\ndata: " + to_text(data_of(event)) + "\n\n";
  }
  return text;
}

}  // namespace repose::server
