#include "server/json/job_json.hpp"

#include "engine/evaluate.hpp"
#include "server/json/text.hpp"

namespace repose::server {

namespace {

Json summary(const db::CalibrationRecord& record) {
  Json json;
  json["id"] = record.id;
  json["name"] = record.name;
  json["state"] = record.state;
  json["created_at"] = print_time(record.created_at);
  json["started_at"] = time_or_null(record.started_at);
  json["finished_at"] = time_or_null(record.finished_at);
  json["misfit"] = record.misfit ? number_or_null(*record.misfit) : Json(nullptr);
  json["progress"] = document_or_null(record.progress);
  json["error"] = record.error ? Json(*record.error) : Json(nullptr);
  return json;
}

}  // namespace

std::string print_job(const db::CalibrationRecord& record,
                      const std::optional<std::string>& material,
                      const std::optional<db::MeasurementSetRecord>& set) {
  Json json = summary(record);
  json["material"] = material ? Json(*material) : Json(nullptr);
  json["measurement_set"] =
      set ? Json{{"name", set->name}, {"version", set->version}} : Json(nullptr);
  json["study"] = document_or_null(record.request);
  json["fit"] = document_or_null(record.fit);
  return to_text(json);
}

Page print_jobs(const std::vector<db::CalibrationRecord>& records, int limit) {
  Json items = Json::array();
  for (const auto& record : records) items.push_back(summary(record));
  return print_page(std::move(items), limit, records.empty() ? Json() : Json(records.back().id));
}

Page print_used(const std::vector<db::UsedEvaluation>& used, int limit) {
  Json items = Json::array();
  for (const auto& [ordinal, evaluation] : used) {
    Json item;
    item["ordinal"] = ordinal;
    item["key"] = evaluation.key;
    item["engine_version"] = evaluation.engine_version;
    item["seconds"] = number_or_null(evaluation.seconds);
    item["created_at"] = print_time(evaluation.created_at);
    item["question"] = document_or_null(evaluation.question);
    item["answer"] = document_or_null(evaluation.answer);
    items.push_back(std::move(item));
  }
  return print_page(std::move(items), limit, used.empty() ? Json() : Json(used.back().ordinal));
}

std::string print_health(const std::string& database,
                         const std::map<std::string, std::int64_t>& jobs) {
  Json json;
  json["status"] = "ok";
  json["database"] = database;
  json["engine_version"] = engine::version();
  json["jobs"] = Json::object();
  for (const auto& [state, count] : jobs) json["jobs"][state] = count;
  return to_text(json);
}

}  // namespace repose::server
