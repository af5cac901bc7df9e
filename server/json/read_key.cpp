#include "server/json/read_key.hpp"

#include <array>
#include <utility>
#include <vector>

namespace repose::server {

using engine::MaterialId;

namespace {

/// Complains, or gives the materials: as many as the scope wants.
std::optional<std::vector<MaterialId>> read_between(const Place& place,
                                                    std::string_view field,
                                                    engine::Scope scope) {
  const std::size_t wanted = engine::materials_of(scope);
  static constexpr std::array<std::string_view, 3> forms{
      "nothing: it belongs to no material", "one material", "two materials"};
  const std::string allowed =
      std::string(forms.at(wanted)) + (wanted > 0 ? " of " + listed(engine::material_names) : "");
  const auto elements = place.elements();
  if (place.exists() && !place.json().is_array()) return std::nullopt;
  if (elements.size() != wanted) {
    place.complain(std::string(field) + " is named by its field and " + std::string(forms[wanted]),
                   allowed);
    return std::nullopt;
  }
  std::vector<MaterialId> between;
  for (const Place& element : elements) {
    const auto index = element.one_of(engine::material_names, "material");
    if (!index) return std::nullopt;
    between.push_back(static_cast<MaterialId>(*index));
  }
  if (wanted == 2 && between[0] == MaterialId::wall && between[1] == MaterialId::wall) {
    place.complain("two walls never touch: at least one of the two is grain", allowed);
    return std::nullopt;
  }
  return between;
}

}  // namespace

std::optional<NamedParameter> read_key(Members& members) {
  const auto names = engine::parameter_names();
  const Place field_place = members.required("field", listed(names));
  const Place between_place = members.optional("between");
  if (!field_place.exists()) return std::nullopt;
  const auto field = field_place.text(200);
  if (!field) return std::nullopt;
  const engine::ParameterInfo* info = engine::find_parameter(*field);
  if (info == nullptr) {
    field_place.complain("there is no parameter \"" + *field + "\"" + did_you_mean(*field, names),
                         listed(names));
    return std::nullopt;
  }
  auto between = read_between(between_place, *field, info->scope);
  if (!between) return std::nullopt;
  engine::ParameterKey key = engine::make_key(*field, std::move(*between));
  std::string text = engine::to_string(key);
  return NamedParameter{std::move(key), info->field, std::move(text)};
}

}  // namespace repose::server
