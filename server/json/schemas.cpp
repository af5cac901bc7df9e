#include "server/json/schemas.hpp"

#include <span>

#include "server/api/route.hpp"
#include "server/json/catalogue_schema.hpp"
#include "server/json/openapi.hpp"

/// Made by the build from schemas/*.json.
extern const std::span<const std::pair<std::string_view, std::string_view>> embedded_schemas;

namespace repose::server {

std::vector<std::pair<std::string, std::string>> generated_schemas() {
  return {{"generated/effects.schema.json", to_text(effects_schema(), 2) + "\n"},
          {"generated/experiments.schema.json", to_text(experiments_schema(), 2) + "\n"},
          {"generated/openapi.json", print_openapi(routes()) + "\n"}};
}

std::vector<std::pair<std::string, std::string>> written_schemas() {
  std::vector<std::pair<std::string, std::string>> result;
  for (const auto& [name, text] : embedded_schemas) result.emplace_back(name, text);
  return result;
}

}  // namespace repose::server
