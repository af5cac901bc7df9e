#include "server/measurements.hpp"

#include <utility>

#include "server/jobs/clock.hpp"
#include "server/json/measurement_set_json.hpp"

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

/// A name that stands in an address as it is.
bool is_name(std::string_view text) {
  constexpr std::string_view letters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
  constexpr std::size_t longest = 64;
  return !text.empty() && text.size() <= longest && text.find_first_not_of(letters) == text.npos;
}

}  // namespace

Answer<std::string> put_measurement_set(db::Store& store,
                                        const std::string& name,
                                        std::string_view content,
                                        const std::optional<std::string>& table_of) {
  if (!is_name(name)) {
    return Unexpected{invalid("a set cannot have that name",
                              {{"name",
                                "a name stands in addresses",
                                "\"" + name.substr(0, 64) + "\"",
                                "1 to 64 letters, digits, dots, underscores and hyphens"}})};
  }
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
  ResolvedSubmission result{submission->study, {submission->material, std::nullopt}};
  if (!submission->set) return result;
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
  return result;
}

}  // namespace repose::server
