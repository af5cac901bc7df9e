/// The material library: published properties of grains, with their sources and doubts. The facts
/// live in server/materials/*.json and in the program; here they are read and printed.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/parameter_set.hpp"

namespace repose::server {

/// A value or a range as one place of the source prints it, in the unit of its property.
struct PublishedValue {
  double lower = 0.0, upper = 0.0;  ///< equal where one value is printed
  std::optional<double> moisture;   ///< at which it holds, % of wet mass
  std::string variant;              ///< of the grain ("dehulled"); empty: no distinction made
  std::string doubt;                ///< of the reading or of the source; empty: none
  std::vector<std::string> sources;
};

struct PublishedProperty {
  /// A parameter of the engine where `key` is there, else a name of its own ("grain_length").
  std::string property;
  std::string label;
  std::string unit;  ///< of all numbers; the engine's symbol where `key` is there
  std::optional<engine::ParameterKey> key;
  std::string surface;  ///< what the grain meets; empty where that is nothing or its own kind
  double lower = 0.0, upper = 0.0;  ///< of all values
  std::optional<double> representative;
  std::string experiment, observable;  ///< that show it; empty: none does
  std::vector<PublishedValue> values;
  std::string doubt;

  [[nodiscard]] bool is_range() const { return lower < upper; }
  /// The representative value where the source names one, else the middle.
  [[nodiscard]] double middle() const { return representative.value_or(0.5 * (lower + upper)); }
  /// "sliding_friction.coefficient:grain-wall", "grain_length"
  [[nodiscard]] std::string name() const;
};

struct PublishedMaterial {
  std::string name;
  std::string title;
  std::vector<PublishedProperty> properties;
};

struct MaterialLibrary {
  std::string citation;
  std::string reading;  ///< how the numbers are to be read
  std::vector<PublishedMaterial> materials;
  std::vector<PublishedProperty> stand_ins;  ///< where a grain has no published value
};

const MaterialLibrary& material_library();

/// Null where there is none of that name.
const PublishedMaterial* find_material(std::string_view name);

/// "there is no material 'soy' (did you mean ...); there are ..."
std::string no_such_material(std::string_view name);

/// {"citation", "reading", "items": [{"name", "title", "properties"}]}
std::string print_material_list();

/// The facts of a material that is there (schemas/published_material.schema.json).
std::string print_material(std::string_view name);

}  // namespace repose::server
