#include "engine/size_population.hpp"

#include "engine/visit_population.hpp"

namespace repose::engine {

SizePopulation size_population(const ParameterSet& parameters) {
  SizePopulation result;
  visit_population(parameters, [&result]<class E>(const E*, const typename E::Parameters& p) {
    if constexpr (PopulateHook<E>) {
      result.volume = [p](Random& random) { return E::populate(p, random); };
      result.smallest = E::smallest(p);
      result.largest = E::largest(p);
    }
  });
  return result;
}

std::vector<std::string_view> effects_on_size(const ParameterSet& parameters) {
  std::vector<std::string_view> names;
  visit_population(parameters, [&names]<class E>(const E*, const typename E::Parameters&) {
    if constexpr (PopulateHook<E>) names.push_back(E::text.name);
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
