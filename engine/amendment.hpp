/// Amendment: the parameters that hold under an experiment's conditions.
#pragma once

#include "engine/condition.hpp"
#include "engine/parameter_set.hpp"

namespace repose::engine {

/// The set with every effect of the stage `amendment` that is on applied to it: what an effect
/// amends is multiplied by its factor. A parameter that the set lacks stays at its null.
ParameterSet amended(const ParameterSet& parameters, const Conditions& conditions);

}  // namespace repose::engine
