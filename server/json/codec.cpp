#include "server/json/codec.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "engine/unit.hpp"
namespace repose::server {

using engine::FieldInfo;
using engine::Unit;

namespace {

std::string with_unit(double value, const Unit& unit) {
  std::string text = engine::short_number(value);
  if (unit.symbol != "1") text += " " + std::string(unit.symbol);
  return text;
}

std::string bounds_text(const FieldInfo& field, const Unit& unit) {
  const std::string lower = engine::short_number(field.lower / unit.factor);
  const std::string upper = with_unit(field.upper / unit.factor, unit);
  if (std::isnan(field.upper)) return "at least " + with_unit(field.lower / unit.factor, unit);
  if (std::isnan(field.lower)) return "at most " + upper;
  return lower + " to " + upper;
}

/// Digits of the shortest decimal that reads back.
std::size_t length_of(double value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return static_cast<std::size_t>(end - text.data());
}

std::vector<std::string_view> names_of(std::span<const FieldInfo> fields) {
  std::vector<std::string_view> names;
  for (const FieldInfo& field : fields) names.push_back(field.name);
  return names;
}

}  // namespace

std::vector<std::string_view> units_like(const Unit& unit) {
  std::vector<std::string_view> symbols;
  for (const Unit& other : engine::unit::all()) {
    if (other.dimension == unit.dimension) symbols.push_back(other.symbol);
  }
  return symbols;
}

std::string form_of_number(const Unit& unit) {
  std::string symbols;
  for (const std::string_view symbol : units_like(unit)) {
    symbols += (symbols.empty() ? "\"" : " or \"") + std::string(symbol) + "\"";
  }
  return R"({"value": number, "unit": )" + symbols + "}";
}

std::optional<Unit> read_unit(const Place& place, const Unit& like, std::string_view what) {
  const auto symbol = place.text(32);
  if (!symbol) return std::nullopt;
  const auto unit = engine::unit::find(*symbol);
  const auto allowed = units_like(like);
  if (!unit) {
    place.complain("there is no unit \"" + *symbol + "\"" + did_you_mean(*symbol, allowed),
                   listed(allowed));
    return std::nullopt;
  }
  if (unit->dimension != like.dimension) {
    place.complain(std::string(what) + " is not measured in \"" + *symbol + "\"", listed(allowed));
    return std::nullopt;
  }
  return unit;
}

bool within_bounds(const Place& place,
                   double value,
                   const Unit& unit,
                   const FieldInfo& field,
                   std::string_view what) {
  // A bound given in another unit may differ from ours by rounding.
  const double slack = 1e-12 * std::abs(value);
  const bool low = !std::isnan(field.lower) && value < field.lower - slack;
  const bool high = !std::isnan(field.upper) && value > field.upper + slack;
  if (std::isfinite(value) && !low && !high) return true;
  const std::string allowed = bounds_text(field, unit);
  place.complain(
      std::string(what) + " must lie in " + allowed, with_unit(value / unit.factor, unit), allowed);
  return false;
}

std::optional<double> read_bounded(const Place& place,
                                   const Unit& unit,
                                   const FieldInfo& field,
                                   std::string_view what) {
  const auto number = place.number();
  if (!number) return std::nullopt;
  const double value = *number * unit.factor;
  if (!within_bounds(place, value, unit, field, what)) return std::nullopt;
  return value;
}

std::optional<double> read_field(const Place& place,
                                 const FieldInfo& field,
                                 std::string_view what) {
  if (!field.choices.empty()) {
    const auto index =
        place.one_of(field.choices, std::string(field.name) + " of " + std::string(what));
    if (!index) return std::nullopt;
    return static_cast<double>(*index);
  }
  const std::string name = std::string(field.name) + " of " + std::string(what);
  if (!place.exists() || !place.json().is_object()) {
    place.complain(name + " is a number with its unit", form_of_number(field.unit));
    return std::nullopt;
  }
  Members members(place);
  const Place value = members.required("value", "a number");
  const Place unit_place = members.required("unit", listed(units_like(field.unit)));
  members.no_others();
  if (!value.exists() || !unit_place.exists()) return std::nullopt;
  const auto unit = read_unit(unit_place, field.unit, name);
  if (!unit) return std::nullopt;
  return read_bounded(value, *unit, field, name);
}

void read_fields(const Place& place,
                 std::span<const FieldInfo> fields,
                 std::string_view what,
                 const FieldSink& sink) {
  if (!place.exists()) return;
  const auto names = names_of(fields);
  for (const auto& [name, member] : Members(place).all()) {
    const auto field = std::ranges::find(fields, std::string_view(name), &FieldInfo::name);
    if (field == fields.end() && sink.other && sink.other(name, member)) continue;
    if (field == fields.end()) {
      const std::string quoted = "\"" + name.substr(0, 64) + "\"";
      member.complain(std::string(what) + " has no " + quoted + did_you_mean(name, names),
                      quoted,
                      listed(names));
      continue;
    }
    if (sink.named) sink.named(*field, member);
    if (const auto value = read_field(member, *field, what)) sink.value(*field, *value, member);
  }
}

std::optional<double> exactly_in(double value, const Unit& unit) {
  const double infinity = std::numeric_limits<double>::infinity();
  std::optional<double> best;
  // The rounding errors of the division here and of the product there: a few neighbours.
  double candidate = value / unit.factor;
  for (int i = 0; i < 4; ++i) candidate = std::nextafter(candidate, -infinity);
  for (int i = 0; i < 9; ++i) {
    if (candidate * unit.factor == value && (!best || length_of(candidate) < length_of(*best))) {
      best = candidate;
    }
    candidate = std::nextafter(candidate, infinity);
  }
  return best;
}

Unit exact_unit(double value, const Unit& preferred) {
  if (exactly_in(value, preferred)) return preferred;
  for (const Unit& unit : engine::unit::all()) {
    if (unit.dimension == preferred.dimension && unit.factor == 1.0) return unit;
  }
  return preferred;
}

Json print_field(double value, const FieldInfo& field) {
  if (!field.choices.empty() && value >= 0.0 && value == std::floor(value) &&
      value < static_cast<double>(field.choices.size())) {
    return field.choices[static_cast<std::size_t>(value)];
  }
  const Unit unit = exact_unit(value, field.unit);
  return {{"value", exactly_in(value, unit).value_or(value)}, {"unit", unit.symbol}};
}

Json in_unit(double value, const Unit& unit) {
  // Less than nothing is nothing: of two zeros the neighbours above begin with the negative one.
  return number_or_null(exactly_in(value, unit).value_or(value / unit.factor) + 0.0);
}

}  // namespace repose::server
