#include "server/cli/assignment.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/catalogue.hpp"
#include "server/json/codec.hpp"
#include "server/json/place.hpp"
#include "server/letters.hpp"
#include "server/report/number_text.hpp"

namespace repose::server {

using engine::FieldInfo;
using engine::MaterialId;
using engine::Result;
using engine::Unexpected;
using engine::Unit;

namespace {

std::string quoted(std::string_view text) { return "'" + std::string(text) + "'"; }

std::string accepted_units(const Unit& unit) { return listed(units_like(unit)); }

std::string range_text(const FieldInfo& field) {
  const auto shown = [&](double value) { return number_text(value / field.unit.factor); };
  return shown(field.lower) + " to " + shown(field.upper) + unit_suffix(field.unit);
}

/// The number and its unit against the field's; the error starts with what was written.
Result<double, std::string> parse_value(const FieldInfo& field, std::string_view written) {
  const std::string_view text = trimmed(written);
  for (std::size_t i = 0; i < field.choices.size(); ++i) {
    if (text == field.choices[i]) return static_cast<double>(i);
  }
  if (!field.choices.empty()) {
    return Unexpected{quoted(text) + " is not a choice of " + std::string(field.name) +
                      "; write one of " + listed(field.choices)};
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || !std::isfinite(value)) {
    return Unexpected{quoted(text) + " is not a number; write " + std::string(field.name) +
                      "=NUMBER" + unit_suffix(field.unit)};
  }
  const auto length = static_cast<std::size_t>(end - text.data());
  const std::string_view symbol = trimmed(text.substr(length));
  if (symbol.empty()) {
    if (field.unit.dimension != engine::Dimension{}) {
      return Unexpected{quoted(text) + " lacks its unit; write " + std::string(text) +
                        std::string(field.unit.symbol) + ", or another of " +
                        accepted_units(field.unit)};
    }
  } else {
    const std::optional<Unit> unit = engine::unit::find(symbol);
    if (!unit || unit->dimension != field.unit.dimension) {
      return Unexpected{quoted(symbol) + " is not a unit of " + std::string(field.name) +
                        "; accepted are " + accepted_units(field.unit)};
    }
    value *= unit->factor;
  }
  const auto within = [&](double si) { return si >= field.lower && si <= field.upper; };
  if (!within(value) && symbol.empty() && within(value * field.unit.factor)) {
    return Unexpected{quoted(text) + " lacks its unit; write " + std::string(text) +
                      std::string(field.unit.symbol) + ", for as a plain number it is " +
                      number_text(value / field.unit.factor) + unit_suffix(field.unit)};
  }
  if (!within(value)) {
    return Unexpected{quoted(text) + " is out of range; " + std::string(field.name) +
                      " must lie in " + range_text(field)};
  }
  return value;
}

/// "grain-wall" -> materials; the error is a name that is none.
Result<std::vector<MaterialId>, std::string_view> parse_between(std::string_view text) {
  std::vector<MaterialId> between;
  while (!text.empty()) {
    const std::size_t dash = text.find('-');
    const auto& names = engine::material_names;
    const std::string_view name = text.substr(0, dash);
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) return Unexpected{name};
    between.push_back(static_cast<MaterialId>(found - names.begin()));
    text = dash == text.npos ? std::string_view{} : text.substr(dash + 1);
  }
  return between;
}

std::string wanted_key(std::string_view field, engine::Scope scope) {
  std::string name(field);
  switch (scope) {
    case engine::Scope::global:
      return name;
    case engine::Scope::material:
      return name + ":grain or " + name + ":wall";
    case engine::Scope::pair:
      return name + ":grain-grain or " + name + ":grain-wall";
  }
  return name;
}

}  // namespace

Result<ParameterAssignment, std::string> parse_parameter(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == text.npos) {
    return Unexpected{quoted(text) +
                      " assigns nothing; write FIELD:grain-grain=VALUE, for instance "
                      "sliding_friction.coefficient:grain-wall=0.3"};
  }
  const std::string_view left = trimmed(text.substr(0, equals));
  const std::size_t colon = left.find(':');
  const std::string_view field = left.substr(0, colon);
  const engine::ParameterInfo* info = engine::find_parameter(field);
  if (info == nullptr) {
    return Unexpected{"there is no parameter " + quoted(field) +
                      did_you_mean(field, engine::parameter_names()) +
                      "; `repose catalogue` lists them all"};
  }
  const auto between = parse_between(colon == left.npos ? "" : left.substr(colon + 1));
  const std::string instead = "; write " + wanted_key(field, info->scope);
  if (info->scope == engine::Scope::global && colon != left.npos) {
    return Unexpected{quoted(left) + " names a material, and " + std::string(field) +
                      " is of none" + instead};
  }
  if (!between) {
    return Unexpected{quoted(between.error()) + " is no material; there are " +
                      listed(engine::material_names) + instead};
  }
  if (between->size() != engine::materials_of(info->scope)) {
    return Unexpected{quoted(left) + " does not name what it is " +
                      (info->scope == engine::Scope::pair ? "between" : "of") + instead};
  }
  const auto value = parse_value(*info->field, text.substr(equals + 1));
  if (!value) return Unexpected{std::string(left) + ": " + value.error()};
  return ParameterAssignment{engine::make_key(field, *between), *value};
}

Result<SettingAssignment, std::string> parse_setting(const engine::ExperimentInfo& info,
                                                     std::string_view text) {
  std::vector<std::string_view> names;
  for (const FieldInfo& field : info.settings) names.push_back(field.name);
  const std::size_t equals = text.find('=');
  if (equals == text.npos) {
    return Unexpected{quoted(text) + " assigns nothing; write NAME=VALUE"};
  }
  const std::string_view name = trimmed(text.substr(0, equals));
  const auto field = std::ranges::find(info.settings, name, &FieldInfo::name);
  if (field == info.settings.end()) {
    return Unexpected{std::string(info.name) + " has no setting " + quoted(name) +
                      did_you_mean(name, names) + "; it has " + listed(names)};
  }
  const auto value = parse_value(*field, text.substr(equals + 1));
  if (!value) return Unexpected{std::string(name) + ": " + value.error()};
  return SettingAssignment{std::string(name), *value};
}

}  // namespace repose::server
