/// Reads the name of a parameter, {"field", "between"}, from an object that may hold more.
#pragma once

#include <optional>
#include <string>

#include "engine/catalogue.hpp"
#include "server/json/place.hpp"

namespace repose::server {

/// A parameter that a document names, and what the catalogue knows of it.
struct NamedParameter {
  engine::ParameterKey key;
  const engine::FieldInfo* field;
  std::string text;  ///< for messages
};

/// Complains, or gives the parameter.
std::optional<NamedParameter> read_key(Members& members);

}  // namespace repose::server
