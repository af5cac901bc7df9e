/// The catalogue -> JSON Schema (draft 7, the part that 2020-12 shares): what a study may name.
#pragma once

#include "server/json/text.hpp"

namespace repose::server {

/// A parameter with a value: one form per parameter of the catalogue.
Json effects_schema();

/// What a measurement says of its experiment: one form per experiment.
Json experiments_schema();

}  // namespace repose::server
