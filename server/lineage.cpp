#include "server/lineage.hpp"

#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "calibrator/comparison.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/comparison_json.hpp"
#include "server/json/fit_json.hpp"
#include "server/json/job_json.hpp"
#include "server/json/text.hpp"

namespace repose::server {

namespace {

Json document(const std::optional<std::string>& text) {
  return text ? Json::parse(*text, nullptr, false) : Json(nullptr);
}

std::optional<std::int64_t> parent_of(const db::CalibrationRecord& record) {
  const Json request = document(record.request);
  if (!request.is_object() || !request.contains("extends")) return std::nullopt;
  return request["extends"].value("calibration", std::int64_t{0});
}

/// The first ancestor; one whose parent is gone is its own.
db::CalibrationRecord root_of(const db::Store& store, db::CalibrationRecord record) {
  std::set<std::int64_t> seen;
  while (seen.insert(record.id).second) {
    const auto parent = parent_of(record);
    auto found = parent ? store.calibration(*parent) : std::nullopt;
    if (!found) break;
    record = *std::move(found);
  }
  return record;
}

Json print_quality(const db::CalibrationRecord& record) {
  const auto calibration = parse_calibration(record.request);
  if (!calibration || !record.fit || record.state != "done") return nullptr;
  const auto fit = parse_fit(*calibration, *record.fit);
  if (!fit) return nullptr;
  return print_fit_quality(calibrator::compare(*calibration, *fit));
}

/// The verdict of its last finished diagnosis.
Json print_verdict(const db::Store& store, std::int64_t calibration) {
  for (const db::DiagnosisRecord& record : store.diagnoses(calibration)) {
    if (record.state != "done") continue;
    const Json result = document(record.result);
    return {{"diagnosis", record.id},
            {"verdict", result.value("verdict", Json(nullptr))},
            {"grade", result.value("grade", Json(nullptr))},
            {"text", result.value("text", Json(nullptr))}};
  }
  return nullptr;
}

Json print_item(const db::Store& store, const db::CalibrationRecord& record) {
  const Json request = document(record.request);
  const Json extends =
      request.is_object() ? request.value("extends", Json::object()) : Json::object();
  const Json fit = document(record.fit);
  Json item{{"calibration", record.id},
            {"parent", extends.value("calibration", Json(nullptr))},
            {"effect", extends.value("effect", Json(nullptr))},
            {"diagnosis", extends.value("diagnosis", Json(nullptr))},
            {"name", record.name},
            {"state", record.state},
            {"created_at", print_time(record.created_at)}};
  item["finished_at"] = record.finished_at ? Json(print_time(*record.finished_at)) : nullptr;
  item["quality"] = print_quality(record);
  item["parameters"] = fit.is_object() ? fit.value("parameters", Json::array()) : Json::array();
  item["verdict"] = print_verdict(store, record.id);
  return item;
}

}  // namespace

Answer<std::string> lineage(const db::Store& store, std::int64_t id) {
  auto record = store.calibration(id);
  if (!record) {
    return engine::Unexpected{
        Refusal{Refusal::Kind::not_found, "there is no calibration " + std::to_string(id), {}}};
  }
  std::vector<db::CalibrationRecord> waiting{root_of(store, *std::move(record))};
  Json items = Json::array();
  std::set<std::int64_t> seen;
  while (!waiting.empty()) {
    const db::CalibrationRecord next = std::move(waiting.back());
    waiting.pop_back();
    if (!seen.insert(next.id).second) continue;
    items.push_back(print_item(store, next));
    auto children = store.children(next.id);
    waiting.insert(waiting.end(), children.rbegin(), children.rend());
  }
  return to_text(Json{{"asked", id}, {"items", std::move(items)}});
}

}  // namespace repose::server
