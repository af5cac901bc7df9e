/// What shape grains have: by the one effect that says so, or spheres.
#pragma once

#include <optional>
#include <string>

#include "engine/clump_shape.hpp"
#include "engine/parameter_set.hpp"

namespace repose::engine {

/// The clump that grains are; nothing where they are spheres. Of a set without a problem.
std::optional<ClumpShape> shape_of_grains(const ParameterSet& parameters);

/// What is wrong with the shape that a set gives its grains; empty where nothing is.
std::string check_shape(const ParameterSet& parameters);

}  // namespace repose::engine
