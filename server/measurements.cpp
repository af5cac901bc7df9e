#include "server/measurements.hpp"

#include <utility>
#include <vector>

#include "db/material_store.hpp"
#include "server/jobs/clock.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/material_library.hpp"
#include "server/json/measurement_set_json.hpp"
#include "server/json/own_material_json.hpp"
#include "server/json/place.hpp"
#include "server/own_materials.hpp"

namespace repose::server {

using engine::Unexpected;

namespace {

Refusal no_such_set(const std::string& name, const std::optional<std::int64_t>& version) {
  return {Refusal::Kind::not_found,
          "there is no measurement set '" + name + "'" +
              (version ? " of version " + std::to_string(*version) : std::string()),
          {}};
}

/// Why no grain was taken from what is kept by that name.
Problem no_grain(db::Store& store, const std::string& pointer, const std::string& name) {
  if (find_material(name) != nullptr) {
    return {pointer,
            "of " + name + " ranges are published, from which no grain is taken by itself",
            "\"" + name + "\", and no grain under materials",
            "a grain under materials, with values that GET /v1/materials/" + name +
                " has: `repose materials " + name + " --study` prints a study to start from"};
  }
  std::vector<std::string> names;
  for (const auto& own : db::MaterialStore(store).list()) names.push_back(own.name);
  const std::string kept = names.empty() ? "" : ", or one of: " + listed(names);
  for (const auto& published : material_library().materials) names.push_back(published.name);
  return {pointer,
          "no grain of that name is kept" + did_you_mean(name, names),
          "\"" + name + "\", and no grain under materials",
          "a grain under materials" + kept};
}

/// The grain of a material of users stands in for one that the study leaves out; nothing, or the
/// problems of a study that is left without.
Problems take_grain(db::Store& store, const std::string& pointer, ResolvedSubmission& submission) {
  if (!submission.source.material) return {};
  const auto own = db::MaterialStore(store).find(*submission.source.material);
  if (!own) {
    if (has_grain(submission.study)) return {};
    const auto study = parse_calibration(submission.study);
    if (study) return {};  // it has its grain's properties elsewhere
    Problems problems = study.error();
    problems.insert(problems.begin(), no_grain(store, pointer, *submission.source.material));
    return problems;
  }
  std::string study = with_grain(submission.study, own->document);
  submission.takes_grain = study != submission.study;
  submission.study = std::move(study);
  return {};
}

}  // namespace

Answer<std::string> put_measurement_set(db::Store& store,
                                        const std::string& name,
                                        std::string_view content,
                                        const std::optional<std::string>& table_of) {
  if (!is_name(name)) return Unexpected{no_name(name)};
  auto set =
      table_of ? parse_measurement_table(content, *table_of) : parse_measurement_set(content);
  if (!set) return Unexpected{invalid("the measurement set", set.error())};
  return print_measurement_set(
      db::MeasurementStore(store).put(name, set->material, set->measurements, microseconds_now()));
}

Answer<std::string> measurement_set(db::Store& store,
                                    const std::string& name,
                                    const std::optional<std::int64_t>& version,
                                    bool as_table) {
  const auto record = db::MeasurementStore(store).find(name, version);
  if (!record) return Unexpected{no_such_set(name, version)};
  return as_table ? print_measurement_table(*record) : print_measurement_set(*record);
}

Answer<ResolvedSubmission> resolve_submission(db::Store& store, std::string_view text) {
  auto submission = parse_submission(text);
  if (!submission) return Unexpected{invalid("the submission", submission.error())};
  ResolvedSubmission result{submission->study, {submission->material, std::nullopt}, false};
  const auto finish = [&](const std::string& named_at) -> Answer<ResolvedSubmission> {
    Problems problems = take_grain(store, named_at, result);
    if (problems.empty()) return std::move(result);
    return Unexpected{invalid("the study", std::move(problems))};
  };
  if (!submission->set) return finish("/material");
  const auto set = db::MeasurementStore(store).find(*submission->set, submission->version);
  if (!set) {
    return Unexpected{invalid("the submission",
                              {{"/measurement_set",
                                no_such_set(*submission->set, submission->version).message,
                                *submission->set,
                                "a set and a version that are kept"}})};
  }
  result.study = with_measurements(submission->study, set->measurements);
  result.source.set = set->id;
  if (submission->material) return finish("/material");
  result.source.material = set->material;
  return finish("/measurement_set");
}

}  // namespace repose::server
