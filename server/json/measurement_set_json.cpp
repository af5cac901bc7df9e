#include "server/json/measurement_set_json.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <system_error>
#include <utility>

#include "server/json/csv.hpp"
#include "server/json/labels.hpp"
#include "server/json/place.hpp"
#include "server/json/study.hpp"
#include "server/json/text.hpp"
#include "server/letters.hpp"

namespace repose::server {

namespace {

constexpr std::size_t longest_name = 100;     // of a material
constexpr std::size_t longest_set_name = 64;  // see is_name()

/// A column of a table: the member of a measurement of that name, and whether it is a number.
struct Column {
  std::string_view name;
  bool number;
};
constexpr std::array<Column, 11> columns{{{"experiment", false},
                                          {"observable", false},
                                          {"value", true},
                                          {"unit", false},
                                          {"standard_error", true},
                                          {"standard_deviation", true},
                                          {"replicates", true},
                                          {"allowance", true},
                                          {"role", false},
                                          {"source", false},
                                          {"settings", false}}};

/// A number where it is one; else the text, of which the reader of measurements will complain.
Json number_in(const std::string& text) {
  const char* const end = text.data() + text.size();
  std::int64_t whole = 0;
  const auto as_whole = std::from_chars(text.data(), end, whole);
  if (as_whole.ec == std::errc{} && as_whole.ptr == end) return whole;
  double real = 0.0;
  const auto as_real = std::from_chars(text.data(), end, real);
  if (as_real.ec == std::errc{} && as_real.ptr == end) return real;
  return text;
}

/// "height=300 mm; speed=15 rpm" -> {"height": {"value": 300, "unit": "mm"}, ...}
Json settings_in(std::string_view cell, const std::string& line, ProblemList& problems) {
  Json settings = Json::object();
  while (!cell.empty()) {
    const std::size_t end = std::min(cell.find(';'), cell.size());
    const std::string_view part = cell.substr(0, end);
    cell.remove_prefix(std::min(end + 1, cell.size()));
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::string value(trimmed(part.substr(std::min(equals + 1, part.size()))));
    const std::size_t blank = value.find(' ');
    const std::string name(trimmed(part.substr(0, equals)));
    if (settings.contains(name)) {
      problems.add({line + ": settings",
                    "the setting is there twice",
                    "\"" + name.substr(0, longest_name) + "\"",
                    "each setting once"});
    }
    if (blank == std::string::npos) {
      settings[name] = value;  // a choice by its name
    } else {
      settings[name] = {{"value", number_in(value.substr(0, blank))},
                        {"unit", trimmed(std::string_view(value).substr(blank))}};
    }
  }
  return settings;
}

std::string settings_text(const Json& settings) {
  std::string text;
  for (const auto& [name, setting] : settings.items()) {
    text += (text.empty() ? "" : "; ") + name + "=";
    text += setting.is_string()
                ? setting.get<std::string>()
                : setting["value"].dump() + " " + setting["unit"].get<std::string>();
  }
  return text;
}

std::vector<std::string_view> column_names() {
  std::vector<std::string_view> names;
  for (const Column& column : columns) names.push_back(column.name);
  return names;
}

/// Where a person finds a row.
std::string line_of(const CsvRow& row) { return "line " + std::to_string(row.line); }

/// The measurements of a table, as a study has them; complains of its form.
Json read_rows(const std::vector<CsvRow>& rows, ProblemList& problems) {
  Json measurements = Json::array();
  std::vector<const Column*> head;
  for (const std::string& cell : rows.front().cells) {
    const std::string name(trimmed(cell));
    const auto found = std::ranges::find(columns, std::string_view(name), &Column::name);
    if (found == columns.end()) {
      problems.add({line_of(rows.front()),
                    "there is no such column" + did_you_mean(name, column_names()),
                    "\"" + name.substr(0, longest_name) + "\"",
                    listed(column_names())});
    }
    if (found != columns.end() && std::ranges::find(head, &*found) != head.end()) {
      problems.add({line_of(rows.front()),
                    "the column is there twice",
                    "\"" + name + "\"",
                    "each column once"});
    }
    head.push_back(found == columns.end() ? nullptr : &*found);
  }
  for (const CsvRow& row : std::span(rows).subspan(1)) {
    if (row.cells.size() > head.size()) {
      problems.add({line_of(row),
                    "the line has more cells than the head",
                    std::to_string(row.cells.size()),
                    std::to_string(head.size())});
    }
    Json measurement = Json::object();
    for (std::size_t k = 0; k < std::min(row.cells.size(), head.size()); ++k) {
      const std::string cell(trimmed(row.cells[k]));
      if (cell.empty() || head[k] == nullptr) continue;
      const std::string name(head[k]->name);
      measurement[name] = head[k]->number      ? number_in(cell)
                          : name == "settings" ? settings_in(cell, line_of(row), problems)
                                               : Json(cell);
    }
    measurements.push_back(std::move(measurement));
  }
  return measurements;
}

/// The rows of a table without the empty cells at their ends, which spreadsheets leave; what is left
/// without any cell is no row.
std::vector<CsvRow> filled_rows(std::string_view text) {
  std::vector<CsvRow> rows = read_csv(text);
  for (CsvRow& row : rows) {
    while (!row.cells.empty() && trimmed(row.cells.back()).empty()) row.cells.pop_back();
  }
  std::erase_if(rows, [](const CsvRow& row) { return row.cells.empty(); });
  return rows;
}

/// Complains of a table whose cells something other than commas separates: no column's name has it.
void check_separator(const CsvRow& head, ProblemList& problems) {
  constexpr std::array<std::pair<char, std::string_view>, 2> others{
      {{';', "semicolons"}, {'\t', "tabs"}}};
  for (const auto& [separator, name] : others) {
    if (head.cells.size() > 1 || head.cells[0].find(separator) == std::string::npos) continue;
    problems.add({line_of(head),
                  "the cells are separated by " + std::string(name),
                  std::string(name),
                  "commas between cells, and a point in numbers: 0.6"});
    return;
  }
}

/// "/measurements/2/value" -> "line 4: value": where a person finds it in the table.
std::string place_in_table(const std::string& pointer, const std::vector<CsvRow>& rows) {
  constexpr std::string_view begin = "/measurements/";
  if (!pointer.starts_with(begin)) return pointer;
  std::size_t index = 0;
  const char* const end = pointer.data() + pointer.size();
  const auto result = std::from_chars(pointer.data() + begin.size(), end, index);
  std::string rest(result.ptr, end);
  return line_of(rows.at(index + 1)) + (rest.empty() ? "" : ": " + rest.substr(1));
}

/// Complains of lines whose letters are those of another encoding.
void check_letters(std::string_view text, ProblemList& problems) {
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (!is_utf8(text.substr(0, end))) {
      problems.add({"line " + std::to_string(line),
                    "its letters are not UTF-8",
                    "another encoding",
                    "a table saved as CSV UTF-8"});
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

std::string read_material(const Place& place) {
  if (!place.exists()) return {};
  auto text = place.text(longest_name);
  if (text && text->empty()) place.complain("a material has a name", "\"\"", "1 to 100 bytes");
  return std::move(text).value_or("");
}

/// Complains of measurements that are none.
void check_measurements(const Json& measurements, ProblemList& problems) {
  const Place place(&measurements, "/measurements", problems);
  if (measurements.is_array() && measurements.empty()) {
    place.complain("a set holds measurements", "none", "one or more");
  }
  check_sources(measurements, "/measurements", problems);
  Study study;
  read_measurements(place, study);
}

Json record_head(const db::MeasurementSetRecord& record) {
  return Json{{"name", record.name},
              {"version", record.version},
              {"material", record.material},
              {"created_at", print_time(record.created_at)}};
}

}  // namespace

engine::Result<MeasurementSet, Problems> parse_measurement_set(std::string_view text) {
  ProblemList problems;
  const auto json = parse_text(text, {}, problems);
  if (!json) return engine::Unexpected{problems.all()};
  Members members(Place(&*json, "", problems));
  const Place material_place = members.required("material", "the name of what was measured");
  check_label(material_place);
  const std::string material = read_material(material_place);
  const Place measurements = members.required("measurements", "a list of measurements");
  members.no_others();
  if (measurements.exists()) check_measurements(measurements.json(), problems);
  if (!problems.empty()) return engine::Unexpected{problems.all()};
  return MeasurementSet{material, to_text(measurements.json())};
}

engine::Result<MeasurementSet, Problems> parse_measurement_table(std::string_view text,
                                                                 const std::string& material) {
  ProblemList problems;
  const Json named = material;
  const Place place(&named, "?material", problems);
  check_label(place);
  read_material(place);
  check_letters(text, problems);
  if (!problems.empty()) return engine::Unexpected{problems.all()};
  const std::vector<CsvRow> rows = filled_rows(text);
  if (rows.empty()) {
    problems.add({"line 1", "the table is empty", "", "a head: " + listed(column_names())});
    return engine::Unexpected{problems.all()};
  }
  check_separator(rows.front(), problems);
  if (!problems.empty()) return engine::Unexpected{problems.all()};
  const Json measurements = read_rows(rows, problems);
  check_measurements(measurements, problems);
  Problems all = problems.all();
  for (Problem& problem : all) problem.pointer = place_in_table(problem.pointer, rows);
  if (!all.empty()) return engine::Unexpected{std::move(all)};
  return MeasurementSet{material, to_text(measurements)};
}

std::string print_measurement_set(const db::MeasurementSetRecord& record) {
  Json json = record_head(record);
  json["measurements"] = Json::parse(record.measurements);
  return to_text(json);
}

std::string print_measurement_table(const db::MeasurementSetRecord& record) {
  const Json measurements = Json::parse(record.measurements);
  CsvRows rows;
  auto& head = rows.emplace_back();
  for (const Column& column : columns) head.emplace_back(column.name);
  for (const Json& measurement : measurements) {
    auto& row = rows.emplace_back();
    for (const Column& column : columns) {
      const Json cell = measurement.value(std::string(column.name), Json());
      row.push_back(cell.is_null()     ? ""
                    : cell.is_string() ? cell.get<std::string>()
                    : cell.is_object() ? settings_text(cell)
                                       : cell.dump());
    }
  }
  return print_csv(rows);
}

Page print_measurement_sets(const std::vector<db::MeasurementSetRecord>& records, int limit) {
  Json items = Json::array();
  for (const auto& record : records) items.push_back(record_head(record));
  return print_page(std::move(items), limit, records.empty() ? Json() : Json(records.back().name));
}

engine::Result<Submission, Problems> parse_submission(std::string_view text) {
  Submission submission;
  submission.study = text;
  ProblemList problems;
  auto json = parse_text(text, {}, problems);
  // What is wrong with it says the reader of studies, who looks at all of it.
  if (!json || !json->is_object()) return submission;
  if (!json->contains("material") && !json->contains("measurement_set")) return submission;
  if (json->contains("material")) {
    submission.material = read_material(Place(&(*json)["material"], "/material", problems));
  }
  if (json->contains("measurement_set")) {
    Members members(Place(&(*json)["measurement_set"], "/measurement_set", problems));
    const Place name = members.required("name", "the name of a set");
    const Place version = members.optional("version");
    members.no_others();
    if (name.exists()) submission.set = name.text(longest_set_name);
    if (version.exists()) submission.version = version.whole(1, INT64_MAX);
    if (json->contains("measurements")) {
      problems.add({"/measurement_set",
                    "the measurements come from one place",
                    "a set, and measurements",
                    "measurement_set or measurements, not both"});
    }
  }
  if (!problems.empty()) return engine::Unexpected{problems.all()};
  json->erase("material");
  json->erase("measurement_set");
  submission.study = to_text(*json);
  return submission;
}

std::string with_measurements(std::string_view study, std::string_view measurements) {
  Json json = Json::parse(study);
  json["measurements"] = Json::parse(measurements);
  return to_text(json);
}

}  // namespace repose::server
