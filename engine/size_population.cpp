#include "engine/size_population.hpp"

#include <tuple>

#include "engine/contact_model.hpp"

namespace repose::engine {

namespace {

/// Calls with an empty E* for every effect on sizes that is on, and its parameters.
template <class Visit, class... E>
void visit_active(const ParameterSet& set, const Visit& visit, const std::tuple<E...>*) {
  const auto one = [&]<class Each>(const Each*) {
    if constexpr (PopulateHook<Each>) {
      const auto p = parameters_of<Each>(set, {MaterialId::grain});
      if (is_active<Each>(p)) visit(static_cast<const Each*>(nullptr), p);
    }
  };
  (one(static_cast<const E*>(nullptr)), ...);
}

template <class Visit>
void visit_active(const ParameterSet& set, const Visit& visit) {
  visit_active(set, visit, static_cast<const AllEffects*>(nullptr));
}

}  // namespace

SizePopulation size_population(const ParameterSet& parameters) {
  SizePopulation result;
  visit_active(parameters, [&result]<class E>(const E*, const typename E::Parameters& p) {
    result.volume = [p](Random& random) { return E::populate(p, random); };
    result.smallest = E::smallest(p);
    result.largest = E::largest(p);
  });
  return result;
}

std::vector<std::string_view> effects_on_size(const ParameterSet& parameters) {
  std::vector<std::string_view> names;
  visit_active(parameters, [&names]<class E>(const E*, const typename E::Parameters&) {
    names.push_back(E::text.name);
  });
  return names;
}

std::string check_sizes(const ParameterSet& parameters) {
  const auto names = effects_on_size(parameters);
  if (names.size() < 2) return {};
  return std::string(names[0]) + " and " + std::string(names[1]) +
         " are both on, but grains have one distribution of sizes: leave one at its null";
}

}  // namespace repose::engine
