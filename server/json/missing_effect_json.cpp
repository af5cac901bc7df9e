#include "server/json/missing_effect_json.hpp"

#include <cmath>
#include <limits>

#include "calibrator/phrase.hpp"
#include "server/json/text.hpp"

namespace repose::server {

namespace {

ComparisonRow read_row(const Json& json, std::size_t measurement) {
  const Json& errors = json.at("errors");
  return {measurement,
          number_or_nan(json.at("measured")),
          number_or_nan(json.at("predicted")),
          number_or_nan(json.at("difference")),
          number_or_nan(errors.at("measurement")),
          number_or_nan(errors.at("tolerance")),
          number_or_nan(errors.at("simulation")),
          number_or_nan(json.at("z")),
          json.contains("z_before") ? number_or_nan(json.at("z_before"))
                                    : std::numeric_limits<double>::quiet_NaN()};
}

std::string trend_text(const Json& json) {
  const double slope = number_or_nan(json.at("slope")), z = number_or_nan(json.at("z"));
  return text_or_empty(json.at("observable")) + " changes with " +
         text_or_empty(json.at("setting")) + ": z " + (slope < 0.0 ? "falls" : "rises") + " by " +
         calibrator::number(std::abs(slope), 2) + " per factor e (" +
         calibrator::number(std::abs(z), 2) + " standard errors)";
}

Json head_of(const db::DiagnosisRecord& record) {
  return {{"id", record.id},
          {"calibration", record.calibration},
          {"state", record.state},
          {"created_at", print_time(record.created_at)},
          {"finished_at", time_or_null(record.finished_at)},
          {"request", document_or_null(record.request)},
          {"progress", document_or_null(record.progress)},
          {"error", record.error ? Json(*record.error) : Json(nullptr)}};
}

}  // namespace

std::string print_diagnosis_record(const db::DiagnosisRecord& record) {
  Json json = head_of(record);
  json["result"] = document_or_null(record.result);
  return to_text(json);
}

std::string print_diagnosis_records(const std::vector<db::DiagnosisRecord>& records) {
  Json items = Json::array();
  for (const db::DiagnosisRecord& record : records) {
    const Json result = document_or_null(record.result);
    Json item = head_of(record);
    for (const char* member : {"verdict", "grade", "text"}) {
      item[member] = result.is_object() ? result.value(member, Json(nullptr)) : Json(nullptr);
    }
    items.push_back(std::move(item));
  }
  return to_text(Json{{"items", std::move(items)}});
}

FitQuality read_quality(const Json& json) {
  return {number_or_nan(json.at("misfit")),
          number_or_nan(json.at("freedom")),
          number_or_nan(json.at("p")),
          number_or_nan(json.at("fitted_z")),
          number_or_nan(json.at("held_out_z"))};
}

engine::Result<DiagnosisRecordDocument, std::string> parse_diagnosis_record(std::string_view text) {
  ProblemList problems;
  const auto json = parse_text(text, own_text(text), problems);
  if (!json) return engine::Unexpected{problems.all().front().message};
  DiagnosisRecordDocument record;
  record.id = json->value("id", std::int64_t{0});
  record.calibration = json->value("calibration", std::int64_t{0});
  record.state = text_or_empty(json->value("state", Json(nullptr)));
  record.error = text_or_empty(json->value("error", Json(nullptr)));
  const Json result = json->value("result", Json(nullptr));
  if (result.is_object()) record.result = to_text(result);
  return record;
}

engine::Result<ComparisonDocument, std::string> parse_comparison(std::string_view text) {
  ProblemList problems;
  const auto json = parse_text(text, own_text(text), problems);
  if (!json) return engine::Unexpected{problems.all().front().message};
  try {
    ComparisonDocument document;
    document.own = read_quality(*json);
    if (json->at("before").is_object()) document.before = read_quality(json->at("before"));
    for (const Json& row : json->at("measurements")) {
      document.rows.push_back(read_row(row, document.rows.size()));
    }
    document.sentences = json->at("text").get<std::vector<std::string>>();
    constexpr double remarkable = 2.0;
    for (const Json& trend : json->at("trends")) {
      if (std::abs(number_or_nan(trend.at("z"))) > remarkable) {
        document.trends.push_back(trend_text(trend));
      }
    }
    return document;
  } catch (const Json::exception& error) {
    return engine::Unexpected{"this is no comparison: " + std::string(error.what())};
  }
}

}  // namespace repose::server
