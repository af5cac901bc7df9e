#include "server/measurements.hpp"

#include <utility>

#include "db/material_store.hpp"
#include "server/jobs/clock.hpp"
#include "server/json/measurement_set_json.hpp"
#include "server/json/own_material_json.hpp"
#include "server/own_materials.hpp"

namespace repose::server {

using engine::Unexpected;

namespace {

Refusal invalid(std::string what, Problems problems) {
  return {Refusal::Kind::invalid, std::move(what), std::move(problems)};
}

Refusal no_such_set(const std::string& name, const std::optional<std::int64_t>& version) {
  return {Refusal::Kind::not_found,
          "there is no measurement set '" + name + "'" +
              (version ? " of version " + std::to_string(*version) : std::string()),
          {}};
}

/// The grain of a material of users stands in for one that the study leaves out.
void take_grain(db::Store& store, ResolvedSubmission& submission) {
  if (!submission.source.material) return;
  const auto own = db::MaterialStore(store).find(*submission.source.material);
  if (!own) return;
  std::string study = with_grain(submission.study, own->document);
  submission.takes_grain = study != submission.study;
  submission.study = std::move(study);
}

}  // namespace

Answer<std::string> put_measurement_set(db::Store& store,
                                        const std::string& name,
                                        std::string_view content,
                                        const std::optional<std::string>& table_of) {
  if (!is_name(name)) return Unexpected{no_name(name)};
  auto set =
      table_of ? parse_measurement_table(content, *table_of) : parse_measurement_set(content);
  if (!set) return Unexpected{invalid("the measurements have problems", set.error())};
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
  if (!submission) return Unexpected{invalid("the submission has problems", submission.error())};
  ResolvedSubmission result{submission->study, {submission->material, std::nullopt}, false};
  if (!submission->set) {
    take_grain(store, result);
    return result;
  }
  const auto set = db::MeasurementStore(store).find(*submission->set, submission->version);
  if (!set) {
    return Unexpected{invalid("the submission has problems",
                              {{"/measurement_set",
                                no_such_set(*submission->set, submission->version).message,
                                *submission->set,
                                "a set and a version that are kept"}})};
  }
  result.study = with_measurements(submission->study, set->measurements);
  result.source.set = set->id;
  if (!result.source.material) result.source.material = set->material;
  take_grain(store, result);
  return result;
}

}  // namespace repose::server
