#include "server/json/study_result_json.hpp"

#include <cmath>

#include "server/json/text.hpp"
#include "server/studies/study_findings.hpp"

namespace repose::server {

namespace {

Json sample_json(const Sample& sample) {
  Json json{{"mean", number_or_null(sample.mean())},
            {"deviation", number_or_null(sample.deviation())},
            {"replicates", sample.values.size()},
            {"values", sample.values},
            {"grain_steps", number_or_null(sample.grain_steps)},
            {"simulated_seconds", number_or_null(sample.simulated_seconds)},
            {"time_step_s", number_or_null(sample.time_step)},
            {"overlap_at_rest_over_radius", number_or_null(sample.largest_overlap_at_rest)}};
  if (sample.failed > 0) {
    json["failed"] = sample.failed;
    json["failure"] = sample.failure;
  }
  return json;
}

Json trend_json(const Trend& trend) {
  return {{"paper_change", number_or_null(trend.paper)},
          {"our_change", number_or_null(trend.ours)},
          {"agrees", trend.agrees ? Json(*trend.agrees) : Json(nullptr)},
          {"clear", trend.clear()}};
}

Json row_json(const StudyResult& result, const std::string& run) {
  const PublishedStudy& study = *result.study;
  Json row{{"run", run}, {"inputs", difference_text(study, run)}};
  for (const StudyExperiment& what : study.experiments) {
    const auto& printed = study.run(run).printed;
    const auto paper = printed.find(what.experiment);
    if (paper == printed.end()) continue;
    const Sample& ours = result.sample(run, what.experiment);
    row[what.experiment] = {
        {"unit", what.unit},
        {"paper", {{"mean", paper->second.mean}, {"deviation", paper->second.deviation}}},
        {"ours", sample_json(ours)},
        {"difference", number_or_null(ours.mean() - paper->second.mean)},
        {"trend", trend_json(trend(result, run, what))}};
  }
  return row;
}

Json table_json(const StudyResult& result, const StudyTable& table) {
  Json groups = Json::array();
  for (const StudyGroup& group : table.groups) {
    Json rows = Json::array();
    for (const std::string& run : group.runs) rows.push_back(row_json(result, run));
    groups.push_back({{"group", group.group}, {"rows", std::move(rows)}});
  }
  Json trends = Json::object();
  for (const StudyExperiment& what : result.study->experiments) {
    const TrendCount count = count_trends(result, table, what);
    trends[what.experiment] = {{"agree", count.agree},
                               {"opposite", count.opposite},
                               {"clear_agree", count.clear_agree},
                               {"clearly_opposite", count.clearly_opposite}};
  }
  return {{"table", table.table},
          {"title", table.title},
          {"groups", std::move(groups)},
          {"trends", std::move(trends)}};
}

Json drop_json(const StudyResult& result) {
  Json rows = Json::array();
  for (const DropRow& row : drop_rows(result)) {
    rows.push_back({{"run", row.run},
                    {"given", row.given},
                    {"read", number_or_null(row.read)},
                    {"percent", number_or_null(row.percent)},
                    {"paper_percent",
                     row.paper ? Json{row.paper->percent_low, row.paper->percent_high} : Json()}});
  }
  return rows;
}

Json cost_json(const StudyResult& result) {
  Json rows = Json::array();
  for (const StudyRun& run : result.study->computing_hours) {
    Json row{{"run", run.run}};
    for (const StudyExperiment& what : result.study->experiments) {
      const CostRatio ratio = cost_ratio(result, run.run, what.experiment);
      row[what.experiment] = {{"paper_ratio", number_or_null(ratio.paper)},
                              {"our_ratio", number_or_null(ratio.ours)}};
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Json variants_json(const StudyResult& result) {
  Json rows = Json::array();
  for (const StudyVariant& variant : result.study->variants) {
    Json row{{"variant", variant.variant}, {"kind", variant.kind}, {"meaning", variant.meaning}};
    for (const StudyExperiment& what : result.study->experiments) {
      const auto explained = explain(result, variant.variant, what);
      if (!explained) continue;
      row[what.experiment] = {{"ours", sample_json(explained->sample)},
                              {"change", number_or_null(explained->change)},
                              {"change_error", number_or_null(explained->error)},
                              {"share_of_gap", number_or_null(explained->share)},
                              {"left", number_or_null(explained->left)}};
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Json search_json(const StudyResult& result) {
  if (!result.search) return nullptr;
  const SearchResult& search = *result.search;
  Json best = Json::object();
  for (const auto& [key, value] : search.fit.best) best[engine::to_string(key)] = value;
  Json samples = Json::object(), paper_best = Json::object();
  for (const auto& [experiment, sample] : search.samples) {
    samples[experiment] = sample_json(sample);
    paper_best[experiment] = sample_json(result.sample(result.study->best, experiment));
  }
  return {{"stop", calibrator::stop_reason_names.at(static_cast<std::size_t>(search.fit.stop))},
          {"evaluations", search.fit.evaluations},
          {"misfit", number_or_null(search.fit.misfit)},
          {"best_si", std::move(best)},
          {"ours", std::move(samples)},
          {"papers_best_run_here", std::move(paper_best)},
          {"remarks", search.fit.remarks}};
}

}  // namespace

std::string print_study_result(const StudyResult& result) {
  const PublishedStudy& study = *result.study;
  Json tables = Json::array();
  for (const StudyTable& table : study.tables) tables.push_back(table_json(result, table));
  const auto fidelity = static_cast<std::size_t>(fidelity_of(result.size));
  const Json json{{"study", study.name},
                  {"citation", study.citation},
                  {"fidelity", engine::fidelity_names.at(fidelity)},
                  {"engine_version", result.engine_version},
                  {"evaluations", result.trials},
                  {"missing", result.missing},
                  {"grain_steps", result.grain_steps},
                  {"drop", drop_json(result)},
                  {"tables", std::move(tables)},
                  {"computing_time", cost_json(result)},
                  {"search", search_json(result)},
                  {"variants", variants_json(result)},
                  {"findings", findings(result)}};
  return to_text(json, 1);
}

}  // namespace repose::server
