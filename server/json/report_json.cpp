#include "server/json/report_json.hpp"

#include <utility>

#include "server/json/calibration_json.hpp"
#include "server/json/fit_json.hpp"
#include "server/json/text.hpp"

namespace repose::server {

using engine::Result;
using engine::Unexpected;

namespace {

/// A text that may be missing or null.
std::string text_member(const Json& document, const char* name) {
  const auto found = document.find(name);
  return found != document.end() && found->is_string() ? found->get<std::string>() : std::string();
}

const Json* object_member(const Json& document, const char* name) {
  const auto found = document.find(name);
  return found != document.end() && found->is_object() ? &*found : nullptr;
}

std::int64_t whole_member(const Json& document, const char* name) {
  const auto found = document.find(name);
  return found != document.end() && found->is_number_integer() ? found->get<std::int64_t>() : 0;
}

Result<Json, std::string> parse_own(std::string_view text) {
  ProblemList problems;
  auto json = parse_text(text, own_text(text), problems);
  if (!json) return Unexpected{problems.all().front().message};
  if (!json->is_object()) return Unexpected{std::string("the document is no object")};
  return *std::move(json);
}

/// The sentence of an error, where the store keeps one: a text, or an object with a message.
std::string error_of(const Json& document) {
  const Json* object = object_member(document, "error");
  return object != nullptr ? text_member(*object, "message") : text_member(document, "error");
}

}  // namespace

Result<CalibrationDocument, std::string> parse_document(std::string_view text) {
  const auto json = parse_own(text);
  if (!json) return Unexpected{json.error()};
  CalibrationDocument document;
  document.id = whole_member(*json, "id");
  document.name = text_member(*json, "name");
  document.state = text_member(*json, "state");
  document.created_at = text_member(*json, "created_at");
  document.started_at = text_member(*json, "started_at");
  document.finished_at = text_member(*json, "finished_at");
  document.error = error_of(*json);
  const Json* study = object_member(*json, "study");
  if (study == nullptr) return document;
  document.study = to_text(*study, 2);
  auto calibration = parse_calibration(to_text(*study));
  if (!calibration) {
    const Problem& first = calibration.error().front();
    return Unexpected{"the study of calibration " + std::to_string(document.id) +
                      " cannot be read any more: " + first.pointer + ": " + first.message};
  }
  document.calibration = *std::move(calibration);
  const Json* fit = object_member(*json, "fit");
  if (fit == nullptr) return document;
  document.engine_version = text_member(*fit, "engine_version");
  auto parsed = parse_fit(*document.calibration, to_text(*fit));
  if (!parsed) return Unexpected{parsed.error()};
  document.fit = *std::move(parsed);
  return document;
}

std::vector<CalibrationItem> parse_items(std::string_view text) {
  std::vector<CalibrationItem> items;
  const auto json = parse_own(text);
  if (!json) return items;
  for (const Json& item : json->value("items", Json::array())) {
    items.push_back({whole_member(item, "id"),
                     text_member(item, "name"),
                     text_member(item, "state"),
                     text_member(item, "created_at")});
  }
  return items;
}

}  // namespace repose::server
