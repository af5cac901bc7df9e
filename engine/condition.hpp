/// Conditions: what an experiment is done in, whatever its apparatus. Every experiment has them as
/// settings; effects of the stage `amendment` read them.
#pragma once

#include <array>
#include <cstddef>

#include "engine/field.hpp"

namespace repose::engine {

struct Conditions {
  double moisture;  ///< 1
};

inline constexpr std::array condition_fields{
    Field<Conditions>{&Conditions::moisture,
                      {.name = "moisture",
                       .unit = unit::percent,
                       .meaning = "water in the grains over their mass with that water",
                       .null_value = 0.12,
                       .lower = 0.0,
                       .upper = 0.6}},
};

/// An experiment's own settings, then the conditions.
template <class S, std::size_t N>
constexpr auto with_conditions(const std::array<Field<S>, N>& fields) {
  std::array<FieldInfo, N + condition_fields.size()> result{};
  for (std::size_t i = 0; i < N; ++i) result[i] = fields[i].info;
  for (std::size_t i = 0; i < condition_fields.size(); ++i) {
    result[N + i] = condition_fields[i].info;
  }
  return result;
}

}  // namespace repose::engine
