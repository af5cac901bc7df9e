#include "server/json/published_study_json.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "server/json/text.hpp"

/// Made by the build from server/studies/*.json.
extern const std::span<const std::pair<std::string_view, std::string_view>> embedded_studies;

namespace repose::server {

namespace {

using Names = std::vector<std::string>;

StudyExperiment read_experiment(const Json& json) {
  return {.experiment = json.at("experiment").get<std::string>(),
          .observable = json.at("observable").get<std::string>(),
          .unit = json.at("unit").get<std::string>(),
          .target = json.at("target").get<double>(),
          .replicates = json.at("replicates").get<int>(),
          .quick_replicates = json.at("quick_replicates").get<int>()};
}

StudyFactor read_factor(const Json& json) {
  return {.factor = json.at("factor").get<std::string>(),
          .unit = json.at("unit").get<std::string>(),
          .parameters = json.at("parameters").get<Names>(),
          .levels = json.at("levels").get<std::vector<std::vector<double>>>()};
}

/// {"run", EXPERIMENT: [mean, deviation], ...}
StudyRun read_run(const Json& json) {
  StudyRun run{json.at("run").get<std::string>(), {}};
  for (const auto& [member, value] : json.items()) {
    if (member == "run") continue;
    run.printed[member] = {value.at(0).get<double>(), value.at(1).get<double>()};
  }
  return run;
}

StudyTable read_table(const Json& json) {
  StudyTable table{json.at("table").get<std::string>(), json.at("title").get<std::string>(), {}};
  for (const Json& group : json.at("groups")) {
    table.groups.push_back({group.at("group").get<std::string>(), group.at("runs").get<Names>()});
  }
  return table;
}

DropAccuracy read_accuracy(const Json& json) {
  return {json.at("coefficient").get<double>(),
          json.at("percent").at(0).get<double>(),
          json.at("percent").at(1).get<double>()};
}

StudyVariant read_variant(const Json& json) {
  return {.variant = json.at("variant").get<std::string>(),
          .kind = json.at("kind").get<std::string>(),
          .meaning = json.at("meaning").get<std::string>(),
          .experiments = json.at("experiments").get<Names>(),
          .set = json.at("set").get<Names>(),
          .settings = json.at("settings").get<Names>()};
}

template <class T>
std::vector<T> read_all(const Json& list, T (*read)(const Json&)) {
  std::vector<T> result;
  result.reserve(list.size());
  for (const Json& item : list) result.push_back(read(item));
  return result;
}

PublishedStudy read_study_data(const Json& json) {
  const Json& drop = json.at("drop");
  return {.name = json.at("name").get<std::string>(),
          .title = json.at("title").get<std::string>(),
          .citation = json.at("citation").get<std::string>(),
          .reading = json.at("reading").get<Names>(),
          .base = json.at("base").get<std::string>(),
          .best = json.at("best").get<std::string>(),
          .experiments = read_all(json.at("experiments"), read_experiment),
          .drop_experiment = drop.at("experiment").get<std::string>(),
          .drop_observable = drop.at("observable").get<std::string>(),
          .drop_accuracy = read_all(drop.at("paper"), read_accuracy),
          .common = json.at("common").get<Names>(),
          .factors = read_all(json.at("factors"), read_factor),
          .runs = read_all(json.at("runs"), read_run),
          .tables = read_all(json.at("tables"), read_table),
          .computing_hours = read_all(json.at("computing_hours"), read_run),
          .variants = read_all(json.at("variants"), read_variant),
          .search = to_text(json.at("search")),
          .quick_search_evaluations = json.at("quick_search_evaluations").get<int>()};
}

const std::vector<PublishedStudy>& all_studies() {
  static const std::vector<PublishedStudy> studies = [] {
    std::vector<PublishedStudy> result;
    for (const auto& [file, text] : embedded_studies) {
      result.push_back(read_study_data(Json::parse(text)));
    }
    return result;
  }();
  return studies;
}

}  // namespace

std::vector<std::string> published_study_names() {
  std::vector<std::string> names;
  for (const PublishedStudy& study : all_studies()) names.push_back(study.name);
  return names;
}

const PublishedStudy* find_published_study(std::string_view name) {
  const auto found = std::ranges::find(all_studies(), name, &PublishedStudy::name);
  return found == all_studies().end() ? nullptr : &*found;
}

}  // namespace repose::server
