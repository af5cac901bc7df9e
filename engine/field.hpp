/// Field<S>: the one device that describes a struct of numbers (effect parameters, experiment
/// settings, materials). Names, units, bounds and meanings are written here once; catalogue, JSON,
/// schemas, command line and web forms are read from it.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

#include "engine/unit.hpp"

namespace repose::engine {

/// Marks a slot of FieldInfo that a field does not have.
inline constexpr double absent = std::numeric_limits<double>::quiet_NaN();

/// What is known of one number. Values are in SI; `unit` is the unit printed for people.
struct FieldInfo {
  std::string_view name;
  Unit unit;
  std::string_view meaning;
  double null_value = absent;  ///< effect: value at which it is exactly absent; setting: default
  double lower = absent;       ///< smallest value allowed, SI
  double upper = absent;       ///< largest value allowed, SI
  double draft = absent;       ///< setting: default at draft fidelity where it differs
  double paper = absent;       ///< setting: default at paper fidelity where it differs
  std::span<const std::string_view> choices = {};  ///< named values: the number is the index
  bool whole = false;  ///< only whole numbers mean anything; others are rounded
};

/// A member of S with its description.
template <class S>
struct Field {
  double S::*member;
  FieldInfo info;
};

/// The descriptions alone, in the order of the table, for those who do not know S.
template <class S, std::size_t N>
constexpr std::array<FieldInfo, N> infos(const std::array<Field<S>, N>& fields) {
  std::array<FieldInfo, N> result{};
  for (std::size_t i = 0; i < N; ++i) result[i] = fields[i].info;
  return result;
}

}  // namespace repose::engine
