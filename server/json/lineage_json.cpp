#include "server/json/lineage_json.hpp"

#include <algorithm>
#include <utility>

#include "server/json/comparison_json.hpp"
#include "server/json/text.hpp"

namespace repose::server {

namespace {

std::optional<std::int64_t> whole(const Json& json) {
  return json.is_number_integer() ? std::optional(json.get<std::int64_t>()) : std::nullopt;
}

LineageItem read_item(const Json& json) {
  LineageItem item;
  item.calibration = json.at("calibration").get<std::int64_t>();
  item.parent = whole(json.at("parent"));
  item.effect = text_or_empty(json.at("effect"));
  item.name = text_or_empty(json.at("name"));
  item.state = text_or_empty(json.at("state"));
  if (json.at("quality").is_object()) item.quality = read_quality(json.at("quality"));
  const Json& verdict = json.at("verdict");
  if (!verdict.is_object()) return item;
  item.diagnosis = whole(verdict.at("diagnosis"));
  item.verdict = text_or_empty(verdict.at("verdict"));
  item.grade = text_or_empty(verdict.at("grade"));
  return item;
}

/// What a study says of the calibration that it extends; nothing of one that begins anew.
Json extension_in(const std::string& study) {
  const Json request = document_or_null(study);
  return request.is_object() ? request.value("extends", Json::object()) : Json::object();
}

Json print_verdict(const db::DiagnosisRecord& record) {
  const Json result = document_or_null(record.result);
  return {{"diagnosis", record.id},
          {"verdict", result.value("verdict", Json(nullptr))},
          {"grade", result.value("grade", Json(nullptr))},
          {"text", result.value("text", Json(nullptr))}};
}

Json print_item(const Descent& descent) {
  const db::CalibrationRecord& record = descent.calibration;
  const Json extends = extension_in(record.request);
  const Json fit = document_or_null(record.fit);
  Json item{{"calibration", record.id},
            {"parent", extends.value("calibration", Json(nullptr))},
            {"effect", extends.value("effect", Json(nullptr))},
            {"diagnosis", extends.value("diagnosis", Json(nullptr))},
            {"name", record.name},
            {"state", record.state},
            {"created_at", print_time(record.created_at)},
            {"finished_at", time_or_null(record.finished_at)}};
  item["quality"] = descent.comparison ? print_fit_quality(*descent.comparison) : Json(nullptr);
  item["parameters"] = fit.is_object() ? fit.value("parameters", Json::array()) : Json::array();
  item["verdict"] = descent.diagnosis ? print_verdict(*descent.diagnosis) : Json(nullptr);
  return item;
}

}  // namespace

std::optional<std::int64_t> parent_of(const std::string& study) {
  return whole(extension_in(study).value("calibration", Json(nullptr)));
}

std::string print_lineage(std::int64_t asked, const std::vector<Descent>& descents) {
  Json items = Json::array();
  for (const Descent& descent : descents) items.push_back(print_item(descent));
  return to_text(Json{{"asked", asked}, {"items", std::move(items)}});
}

engine::Result<std::vector<LineageItem>, std::string> parse_lineage(std::string_view text) {
  ProblemList problems;
  const auto json = parse_text(text, own_text(text), problems);
  if (!json) return engine::Unexpected{problems.all().front().message};
  try {
    std::vector<LineageItem> items;
    for (const Json& item : json->at("items")) items.push_back(read_item(item));
    return items;
  } catch (const Json::exception& error) {
    return engine::Unexpected{"this is no lineage: " + std::string(error.what())};
  }
}

std::vector<LineageItem> path_through(const std::vector<LineageItem>& items,
                                      std::int64_t calibration) {
  std::vector<LineageItem> path;
  std::optional<std::int64_t> next = calibration;
  while (next) {  // up: a parent stands before its children, so this ends
    const auto found = std::ranges::find(items, *next, &LineageItem::calibration);
    if (found == items.end()) break;
    path.insert(path.begin(), *found);
    next = found->parent;
  }
  next = calibration;
  while (next) {  // down
    const LineageItem* newest = nullptr;
    for (const LineageItem& item : items) {
      if (item.parent == next && item.state == "done") newest = &item;
    }
    if (newest != nullptr) path.push_back(*newest);
    next = newest != nullptr ? std::optional(newest->calibration) : std::nullopt;
  }
  std::erase_if(path, [](const LineageItem& item) { return item.state != "done"; });
  return path;
}

}  // namespace repose::server
