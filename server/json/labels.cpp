#include "server/json/labels.hpp"

#include <optional>

#include "server/letters.hpp"

namespace repose::server {

namespace {

void check_member(const Json& json,
                  const char* member,
                  const std::string& pointer,
                  ProblemList& problems) {
  if (!json.is_object() || !json.contains(member)) return;
  check_label(Place(&json[member], pointer_to(pointer, member), problems));
}

void check_submission(const Json& json, const std::string& pointer, ProblemList& problems) {
  if (!json.is_object()) return;
  check_member(json, "name", pointer, problems);
  check_member(json, "material", pointer, problems);
  if (json.contains("measurements")) {
    check_sources(json["measurements"], pointer_to(pointer, "measurements"), problems);
  }
}

/// Of what is no JSON its reader complains.
std::optional<Json> value_of(std::string_view text) {
  ProblemList ignored;
  return parse_text(text, {}, ignored);
}

}  // namespace

void check_label(const Place& place) {
  if (!place.exists() || !place.json().is_string()) return;
  const auto& text = place.json().get_ref<const std::string&>();
  if (!is_utf8(text)) {
    place.complain("its letters are not UTF-8", "another encoding", "letters in UTF-8");
  } else if (has_control_letter(text)) {
    place.complain("control characters are no part of it",
                   "a text with a control character",
                   "a text on one line, without tabs");
  }
}

void check_sources(const Json& measurements, const std::string& pointer, ProblemList& problems) {
  if (!measurements.is_array()) return;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    check_member(measurements[i], "source", pointer_to(pointer, i), problems);
  }
}

Problems problems_of_labels(std::string_view submission) {
  ProblemList problems;
  if (const auto json = value_of(submission)) check_submission(*json, "", problems);
  return problems.all();
}

Problems problems_of_schedule_labels(std::string_view schedule) {
  ProblemList problems;
  const auto json = value_of(schedule);
  if (!json || !json->is_object()) return {};
  check_member(*json, "name", "", problems);
  if (json->contains("study")) check_submission((*json)["study"], "/study", problems);
  return problems.all();
}

calibrator::Calibration with_clean_labels(calibrator::Calibration study) {
  study.name = without_control_letters(study.name);
  for (calibrator::Measurement& measurement : study.measurements) {
    measurement.source = without_control_letters(measurement.source);
  }
  return study;
}

}  // namespace repose::server
