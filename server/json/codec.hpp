/// Field tables <-> JSON: the one reader and the one writer of numbers with units. A unit's
/// dimension and a number's bounds are checked here, and it is converted to SI here.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/field.hpp"
#include "server/json/place.hpp"

namespace repose::server {

/// The unit that stands there. It must have the dimension of `like`; `what` is measured in it.
std::optional<engine::Unit> read_unit(const Place& place,
                                      const engine::Unit& like,
                                      std::string_view what);

/// A number in that unit, in SI and within the bounds of the field.
std::optional<double> read_bounded(const Place& place,
                                   const engine::Unit& unit,
                                   const engine::FieldInfo& field,
                                   std::string_view what);

/// Complains where an SI value is out of the field's bounds; says both in that unit.
bool within_bounds(const Place& place,
                   double value,
                   const engine::Unit& unit,
                   const engine::FieldInfo& field,
                   std::string_view what);

/// The value of a field: {"value", "unit"}, or one of its choices as a text. SI.
std::optional<double> read_field(const Place& place,
                                 const engine::FieldInfo& field,
                                 std::string_view what);

/// An object whose members are fields of a table, each handed on with its SI value. `what` names
/// the owner of the table ("drop", "grain"). Nothing is handed on of a member that has a problem,
/// but `named` is told of it. A member that is no field is a problem unless `other` takes it.
struct FieldSink {
  std::function<void(const engine::FieldInfo&, double, const Place&)> value;
  std::function<void(const engine::FieldInfo&, const Place&)> named = {};
  std::function<bool(std::string_view name, const Place&)> other = {};
};
void read_fields(const Place& place,
                 std::span<const engine::FieldInfo> fields,
                 std::string_view what,
                 const FieldSink& sink);

/// x with x * unit.factor == value exactly, the shortest to write; nothing where there is none.
std::optional<double> exactly_in(double value, const engine::Unit& unit);

/// The field's own unit where the value reads back exactly from it, else SI's.
engine::Unit exact_unit(double value, const engine::Unit& preferred);

/// {"value", "unit"}, or the name of a choice; reads back exactly.
Json print_field(double value, const engine::FieldInfo& field);

/// A value in a unit, for documents that people read: null where it is no number.
Json in_unit(double value, const engine::Unit& unit);

/// The symbols of all units of that dimension.
std::vector<std::string_view> units_like(const engine::Unit& unit);

/// How a number of such a unit is written: {"value": number, "unit": "m" or "mm"}.
std::string form_of_number(const engine::Unit& unit);

}  // namespace repose::server
