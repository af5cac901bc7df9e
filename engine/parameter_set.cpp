#include "engine/parameter_set.hpp"

#include <algorithm>

namespace repose::engine {

ParameterKey make_key(std::string_view field, std::vector<MaterialId> between) {
  std::ranges::sort(between);
  return {std::string(field), std::move(between)};
}

std::string to_string(const ParameterKey& key) {
  std::string text = key.field;
  char separator = ':';
  for (const MaterialId material : key.between) {
    text += separator;
    text += material_names[static_cast<std::size_t>(material)];
    separator = '-';
  }
  return text;
}

std::optional<double> ParameterSet::get(const ParameterKey& key) const {
  const auto found = values_.find(key);
  if (found == values_.end()) return std::nullopt;
  return found->second;
}

}  // namespace repose::engine
