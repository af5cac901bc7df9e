#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "server/json/study.hpp"

namespace repose::server {

namespace {

constexpr std::size_t longest = 100;  // points of a curve

bool is_list(const Json& object, std::string_view name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_array();
}

/// The names of the settings that are given a list of values.
std::vector<std::string> varying(const Json& measurement) {
  std::vector<std::string> names;
  const auto settings = measurement.find("settings");
  if (settings == measurement.end() || !settings->is_object()) return names;
  for (const auto& [name, setting] : settings->items()) {
    if (setting.is_object() && is_list(setting, "value")) names.push_back(name);
  }
  return names;
}

/// Members of a curve that may hold one number for all its points, or one for each.
constexpr std::array<std::string_view, 4> per_point{
    "standard_error", "standard_deviation", "replicates", "allowance"};

/// The numbers along the curve; complains where they do not make one.
std::optional<std::size_t> length_of(const Place& place, const std::string& along) {
  const Json& json = place.json();
  const auto at = [&](const std::string& pointer) {
    return Place(&json, pointer, place.problems());
  };
  const std::string values = pointer_to(place.pointer(), "value");
  const std::string setting =
      pointer_to(pointer_to(pointer_to(place.pointer(), "settings"), along), "value");
  if (!is_list(json, "value")) {
    at(values).complain("a setting with a list of values needs a list of measured ones",
                        "a single value",
                        "as many values as the setting has");
    return std::nullopt;
  }
  const std::size_t length = json.at("value").size();
  const std::string wanted = "a list of " + std::to_string(length);
  if (length < 2 || length > longest) {
    at(values).complain("a curve has 2 to 100 points", std::to_string(length), "2 to 100 values");
    return std::nullopt;
  }
  bool good = true;
  const auto check = [&](const Json& list, const std::string& where, const std::string& allowed) {
    if (!list.is_array() || list.size() == length) return;
    at(where).complain("the lists of a curve are as long as each other",
                       "a list of " + std::to_string(list.size()),
                       allowed);
    good = false;
  };
  const Json& abscissae = json.at("settings").at(along).at("value");
  check(abscissae, setting, wanted);
  for (const std::string_view name : per_point) {
    const auto found = json.find(name);
    if (found != json.end())
      check(*found, pointer_to(place.pointer(), name), "one number, or " + wanted);
  }
  if (good && std::ranges::all_of(abscissae, [&](const Json& x) { return x == abscissae[0]; })) {
    at(setting).complain(
        "a curve runs along a setting that changes", "the same value", "other values");
    good = false;
  }
  return good ? std::optional(length) : std::nullopt;
}

/// The curve's document with the numbers of one point.
Json point_of(const Json& curve, const std::string& along, std::size_t index) {
  Json point = curve;
  point["value"] = curve.at("value").at(index);
  Json& abscissa = point["settings"][along]["value"];
  abscissa = Json(abscissa.at(index));
  for (const std::string_view name : per_point) {
    if (is_list(curve, name)) point[std::string(name)] = curve.at(name).at(index);
  }
  return point;
}

}  // namespace

bool is_curve(const Place& place) {
  const Json& json = place.json();
  return json.is_object() && (is_list(json, "value") || !varying(json).empty());
}

void read_curve(const Place& place, Study& study) {
  const std::vector<std::string> names = varying(place.json());
  if (names.size() != 1) {
    ++study.fitted_named;  // one mistake, one problem
    place.complain("a curve runs along one setting, which has a list of values",
                   names.empty() ? "no such setting" : std::to_string(names.size()) + " of them",
                   R"("settings": {NAME: {"value": [number, ...], "unit"}})");
    return;
  }
  const auto length = length_of(place, names.front());
  if (!length) {
    ++study.fitted_named;
    return;
  }
  std::vector<calibrator::Measurement>& all = study.calibration.measurements;
  const int curve = ++study.curves;
  for (std::size_t i = 0; i < *length; ++i) {
    const std::size_t before = all.size();
    const Json point = point_of(place.json(), names.front(), i);
    read_measurement(Place(&point, place.pointer(), place.problems()), study);
    if (all.size() == before) return;  // its problem is every point's
    all.back().curve = curve;
  }
}

}  // namespace repose::server
