#include "engine/amendment.hpp"

#include <utility>

#include "engine/contact_model.hpp"

namespace repose::engine {

namespace {

/// The materials of every contact of grains.
std::vector<std::vector<MaterialId>> places_of(Scope scope) {
  if (scope == Scope::material) return {{MaterialId::grain}};
  return {{MaterialId::grain, MaterialId::grain}, {MaterialId::grain, MaterialId::wall}};
}

template <std::size_t I>
void amend_one(const ParameterSet& given, const Conditions& conditions, ParameterSet& result) {
  using E = std::tuple_element_t<I, AllEffects>;
  if constexpr (AmendHook<E>) {
    static_assert(E::scope != Scope::global);
    for (const auto& between : places_of(E::scope)) {
      const auto parameters = parameters_of<E>(given, between);
      const ParameterKey key = make_key(E::amends, between);
      const auto value = result.get(key);
      if (!value || !is_active<E>(parameters)) continue;
      result.set(key, *value * E::factor(parameters, conditions));
    }
  }
}

}  // namespace

ParameterSet amended(const ParameterSet& parameters, const Conditions& conditions) {
  ParameterSet result = parameters;
  const auto fold = [&]<std::size_t... I>(std::index_sequence<I...>) {
    (amend_one<I>(parameters, conditions, result), ...);
  };
  fold(std::make_index_sequence<effect_count>{});
  return result;
}

}  // namespace repose::engine
