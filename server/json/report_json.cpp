#include "server/json/report_json.hpp"

#include <stdexcept>
#include <utility>

#include "server/json/calibration_json.hpp"
#include "server/json/fit_json.hpp"
#include "server/json/text.hpp"

namespace repose::server {

namespace {

/// A text that may be missing or null.
std::string text_or_empty(const Json& json, std::string_view name) {
  const auto found = json.find(name);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

CalibrationItem read_item(const Json& json) {
  return {json.at("id").get<std::int64_t>(),
          json.at("name").get<std::string>(),
          json.at("state").get<std::string>(),
          text_or_empty(json, "created_at")};
}

CalibrationDocument read_document(const Json& json) {
  const CalibrationItem item = read_item(json);
  CalibrationDocument document;
  document.id = item.id;
  document.name = item.name;
  document.state = item.state;
  document.created_at = item.created_at;
  document.started_at = text_or_empty(json, "started_at");
  document.finished_at = text_or_empty(json, "finished_at");
  document.error = text_or_empty(json, "error");

  const auto study = json.find("study");
  if (study != json.end() && study->is_object()) {
    document.study = to_text(*study, 2);
    auto calibration = parse_calibration(to_text(*study));
    if (calibration) document.calibration = std::move(calibration).value();
  }
  const auto fit_json = json.find("fit");
  if (document.calibration && fit_json != json.end() && fit_json->is_object()) {
    document.engine_version = text_or_empty(*fit_json, "engine_version");
    auto fit = parse_fit(*document.calibration, to_text(*fit_json));
    if (!fit) throw std::invalid_argument(fit.error());
    document.fit = std::move(fit).value();
  }
  return document;
}

}  // namespace

engine::Result<CalibrationDocument, std::string> parse_document(std::string_view text) {
  ProblemList problems;
  const auto json = parse_text(text, own_text(text), problems);
  if (!json) return engine::Unexpected{problems.all().front().message};
  try {
    return read_document(*json);
  } catch (const std::exception& error) {
    return engine::Unexpected{"this is no calibration's document: " + std::string(error.what())};
  }
}

std::vector<CalibrationItem> parse_items(std::string_view text) {
  ProblemList problems;
  const auto json = parse_text(text, own_text(text), problems);
  std::vector<CalibrationItem> result;
  if (!json || !json->is_object()) return result;
  const auto items = json->find("items");
  if (items == json->end()) return result;
  for (const Json& item : *items) result.push_back(read_item(item));
  return result;
}

}  // namespace repose::server
