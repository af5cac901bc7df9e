#include "server/json/key_json.hpp"

#include <string>

#include "engine/catalogue.hpp"
#include "server/json/codec.hpp"

namespace repose::server {

Json print_key(const engine::ParameterKey& key) {
  Json result{{"field", key.field}};
  if (key.between.empty()) return result;
  Json between = Json::array();
  for (const engine::MaterialId material : key.between) {
    between.push_back(engine::material_names[static_cast<std::size_t>(material)]);
  }
  result["between"] = std::move(between);
  return result;
}

Json print_settings(const engine::Experiment& experiment) {
  Json result = Json::object();
  const engine::ExperimentInfo* info = engine::find_experiment(experiment.name);
  if (info == nullptr) return result;
  for (const engine::FieldInfo& field : info->settings) {
    const auto given = experiment.settings.find(std::string(field.name));
    if (given == experiment.settings.end()) continue;
    result[std::string(field.name)] = print_field(given->second, field);
  }
  return result;
}

}  // namespace repose::server
