/// SizePopulation: how grains differ in size: by the one effect that says so, or not at all.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/parameter_set.hpp"
#include "engine/random.hpp"

namespace repose::engine {

struct SizePopulation {
  std::function<double(Random&)> volume;  ///< of a new grain over mean volume; empty: always 1
  double smallest = 1.0;                  ///< volume over mean volume
  double largest = 1.0;
};

/// The population of a set in which at most one effect on sizes is on.
SizePopulation size_population(const ParameterSet& parameters);

/// The effects on sizes that are on, by name.
std::vector<std::string_view> effects_on_size(const ParameterSet& parameters);

/// What is wrong with a set in which several are on; empty where nothing is.
std::string check_sizes(const ParameterSet& parameters);

}  // namespace repose::engine
