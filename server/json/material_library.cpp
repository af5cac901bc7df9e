#include "server/json/material_library.hpp"

#include <algorithm>
#include <utility>

#include "server/json/place.hpp"
#include "server/json/text.hpp"

/// Made by the build from server/materials/*.json.
extern const std::span<const std::pair<std::string_view, std::string_view>> embedded_materials;

namespace repose::server {

namespace {

const Json& document() {
  static const Json json = Json::parse(embedded_materials.front().second);
  return json;
}

std::vector<std::string> read_sources(const Json& json) {
  return json.at("sources").get<std::vector<std::string>>();
}

std::optional<double> read_optional(const Json& json, const char* member) {
  if (!json.contains(member)) return std::nullopt;
  return json[member].get<double>();
}

PublishedValue read_value(const Json& json) {
  return {.lower = json.at("lower").get<double>(),
          .upper = json.at("upper").get<double>(),
          .moisture = read_optional(json, "moisture"),
          .variant = json.value("variant", ""),
          .doubt = json.value("doubt", ""),
          .sources = read_sources(json)};
}

std::optional<engine::ParameterKey> read_key_of(const Json& json) {
  if (!json.contains("between")) return std::nullopt;
  std::vector<engine::MaterialId> between;
  for (const Json& name : json["between"]) {
    const auto found = std::ranges::find(engine::material_names, name.get<std::string>());
    between.push_back(static_cast<engine::MaterialId>(found - engine::material_names.begin()));
  }
  return engine::make_key(json.at("property").get<std::string>(), std::move(between));
}

PublishedProperty read_property(const Json& json) {
  PublishedProperty result{.property = json.at("property").get<std::string>(),
                           .label = json.at("label").get<std::string>(),
                           .unit = json.at("unit").get<std::string>(),
                           .key = read_key_of(json),
                           .surface = json.value("surface", ""),
                           .lower = json.at("lower").get<double>(),
                           .upper = json.at("upper").get<double>(),
                           .representative = read_optional(json, "representative"),
                           .experiment = json.value("experiment", ""),
                           .observable = json.value("observable", ""),
                           .values = {},
                           .doubt = json.value("doubt", "")};
  for (const Json& value : json.at("values")) result.values.push_back(read_value(value));
  return result;
}

std::vector<PublishedProperty> read_properties(const Json& json) {
  std::vector<PublishedProperty> result;
  for (const Json& property : json) result.push_back(read_property(property));
  return result;
}

MaterialLibrary read_library(const Json& json) {
  MaterialLibrary library{.citation = json.at("citation").get<std::string>(),
                          .reading = json.at("reading").get<std::string>(),
                          .materials = {},
                          .stand_ins = read_properties(json.at("stand_ins"))};
  for (const Json& material : json.at("materials")) {
    library.materials.push_back({material.at("name").get<std::string>(),
                                 material.at("title").get<std::string>(),
                                 read_properties(material.at("properties"))});
  }
  return library;
}

}  // namespace

std::string PublishedProperty::name() const { return key ? to_string(*key) : property; }

const MaterialLibrary& material_library() {
  static const MaterialLibrary library = read_library(document());
  return library;
}

const PublishedMaterial* find_material(std::string_view name) {
  const auto& all = material_library().materials;
  const auto found = std::ranges::find(all, name, &PublishedMaterial::name);
  return found == all.end() ? nullptr : &*found;
}

std::string no_such_material(std::string_view name) {
  std::vector<std::string> names;
  for (const PublishedMaterial& material : material_library().materials) {
    names.push_back(material.name);
  }
  return "there is no material '" + std::string(name) + "'" + did_you_mean(name, names) +
         "; there are " + listed(names);
}

std::string print_material_list() {
  Json items = Json::array();
  for (const PublishedMaterial& material : material_library().materials) {
    std::vector<std::string> properties;
    for (const PublishedProperty& property : material.properties) {
      const std::string name = property.name();
      if (std::ranges::find(properties, name) == properties.end()) properties.push_back(name);
    }
    items.push_back(
        {{"name", material.name}, {"title", material.title}, {"properties", properties}});
  }
  return to_text(Json{{"citation", material_library().citation},
                      {"reading", material_library().reading},
                      {"items", std::move(items)}});
}

std::string print_material(std::string_view name) {
  Json result;
  for (const Json& material : document().at("materials")) {
    if (material.at("name") == name) result = material;
  }
  result["citation"] = material_library().citation;
  result["reading"] = material_library().reading;
  return to_text(result);
}

}  // namespace repose::server
