#include "server/json/fit_list_json.hpp"

#include <utility>

#include "server/json/text.hpp"

namespace repose::server {

namespace {

Json not_determined(const Json& parameters) {
  Json result = Json::array();
  for (const Json& parameter : parameters) {
    if (parameter.value("determined", true)) continue;
    Json key{{"field", parameter["field"]}};
    if (parameter.contains("between")) key["between"] = parameter["between"];
    result.push_back(std::move(key));
  }
  return result;
}

/// What both lists say of a fit.
Json head_of(const ListedFit& listed, const Json& fit) {
  const auto& [calibration, material, set, version] = listed.record;
  return {{"calibration", calibration.id},
          {"name", calibration.name},
          {"material", material ? Json(*material) : Json(nullptr)},
          {"misfit", calibration.misfit ? number_or_null(*calibration.misfit) : Json(nullptr)},
          {"stop", fit.value("stop", Json(nullptr))},
          {"quality", document_or_null(listed.quality)},
          {"in_force", listed.in_force},
          {"parameters", fit.value("parameters", Json::array())}};
}

Json provenance(const db::FitRecord& record, const Json& fit) {
  const std::string address = "/v1/calibrations/" + std::to_string(record.calibration.id);
  return {{"calibration", address},
          {"evaluations", address + "/evaluations"},
          {"study_digest", record.calibration.request_digest},
          {"measurement_set",
           record.set ? Json{{"name", *record.set}, {"version", record.version.value_or(0)}}
                      : Json(nullptr)},
          {"engine_version", fit.value("engine_version", Json(nullptr))},
          {"seed", fit.value("seed", Json(nullptr))},
          {"finished_at", print_time(record.calibration.finished_at.value_or(0))}};
}

Json document_of(const ListedFit& listed) {
  return Json::parse(listed.record.calibration.fit.value_or("{}"));
}

}  // namespace

Page print_fits(const std::vector<ListedFit>& fits, int limit) {
  Json items = Json::array();
  for (const ListedFit& listed : fits) {
    const Json fit = document_of(listed);
    Json item = head_of(listed, fit);
    item["not_determined"] = not_determined(item["parameters"]);
    item["best"] = fit.value("best", Json::array());
    item["remarks"] = fit.value("remarks", Json::array());
    item["provenance"] = provenance(listed.record, fit);
    items.push_back(std::move(item));
  }
  const Json last = fits.empty() ? Json() : Json(fits.back().record.calibration.id);
  return print_page(std::move(items), limit, last);
}

std::string print_best_fits(const std::vector<ListedFit>& fits) {
  Json items = Json::array();
  for (const ListedFit& listed : fits) {
    const Json fit = document_of(listed);
    Json item = head_of(listed, fit);
    item["best"] = fit.value("best", Json(nullptr));
    item["finished_at"] = time_or_null(listed.record.calibration.finished_at);
    items.push_back(std::move(item));
  }
  return to_text(Json{{"items", std::move(items)}});
}

}  // namespace repose::server
