/// Walks the effects that act when grains are made.
#pragma once

#include <tuple>

#include "engine/contact_model.hpp"

namespace repose::engine {

/// Calls visit(const E*, parameters) with an empty pointer for every effect of that stage that is
/// on for the grains.
template <class Visit, class... E>
void visit_population(const ParameterSet& set, const Visit& visit, const std::tuple<E...>*) {
  const auto one = [&]<class Each>(const Each*) {
    if constexpr (Each::stage == Stage::population) {
      const auto p = parameters_of<Each>(set, {MaterialId::grain});
      if (is_active<Each>(p)) visit(static_cast<const Each*>(nullptr), p);
    }
  };
  (one(static_cast<const E*>(nullptr)), ...);
}

template <class Visit>
void visit_population(const ParameterSet& set, const Visit& visit) {
  visit_population(set, visit, static_cast<const AllEffects*>(nullptr));
}

}  // namespace repose::engine
