#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/text_table.hpp"
#include "server/json/material_library.hpp"
#include "server/json/starting_study.hpp"
#include "server/report/number_text.hpp"

namespace repose::server {

namespace {

/// Numbers the sources of a table in the order in which they come.
class Sources {
 public:
  std::string number(const std::vector<std::string>& sources) {
    std::string text;
    for (const std::string& source : sources) {
      const auto found = std::ranges::find(names_, source);
      const auto index = found - names_.begin();
      if (found == names_.end()) names_.push_back(source);
      text += (text.empty() ? "" : " ") + std::to_string(index + 1);
    }
    return text;
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;
};

std::string range_text(double lower, double upper) {
  if (lower == upper) return number_text(lower, 6);
  return number_text(lower, 6) + " to " + number_text(upper, 6);
}

std::string conditions(const PublishedProperty& property, const PublishedValue& value) {
  std::string text = property.surface;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (!value.variant.empty()) add(value.variant);
  if (value.moisture) add("moisture " + number_text(*value.moisture, 3) + " %");
  if (!value.doubt.empty()) add("doubtful");
  return text;
}

void print_list() {
  TextTable table({"name", "grain", "properties"}, "llr");
  for (const PublishedMaterial& material : material_library().materials) {
    table.row({material.name, material.title, std::to_string(material.properties.size())});
  }
  std::cout << table.str() << "\n"
            << material_library().citation << ".\n`repose materials NAME` prints one, "
            << "`repose materials NAME --study` a study to start from.\n";
}

void print_facts(const PublishedMaterial& material) {
  Sources sources;
  TextTable table({"property", "value", "unit", "conditions", "sources"}, "lrlll");
  for (const PublishedProperty& property : material.properties) {
    std::string name = property.name();
    for (const PublishedValue& value : property.values) {
      table.row({name,
                 range_text(value.lower, value.upper),
                 property.unit,
                 conditions(property, value),
                 sources.number(value.sources)});
      name.clear();
    }
    if (!property.representative) continue;
    table.row({name, number_text(*property.representative, 6), property.unit, "representative"});
  }
  std::cout << material.title << "\n\n" << table.str() << "\nSources\n";
  for (std::size_t i = 0; i < sources.names().size(); ++i) {
    std::cout << "  " << i + 1 << "  " << sources.names()[i] << "\n";
  }
  std::cout << "\nDoubts\n";
  for (const PublishedProperty& property : material.properties) {
    if (!property.doubt.empty())
      std::cout << "  " << property.name() << ": " << property.doubt << "\n";
  }
  std::cout << "\nAll after " << material_library().citation << ".\n"
            << material_library().reading << "\n";
}

void print_study(const PublishedMaterial& material) {
  const StartingStudy study = starting_study(material);
  std::cout << study.text;
  std::cerr << "repose: " << material.title << ", to be read before it is run:\n";
  for (const std::string& note : study.notes) std::cerr << "  " << note << "\n";
}

}  // namespace

int materials_command(const MaterialsCommand& command) {
  const bool json = command.form == Form::json;
  if (command.name.empty()) {
    if (json) std::cout << print_material_list() << "\n";
    if (!json) print_list();
    return exit_code::done;
  }
  const PublishedMaterial* material = find_material(command.name);
  if (material == nullptr) {
    std::cerr << "repose: " << no_such_material(command.name) << "\n";
    return exit_code::misused;
  }
  if (command.study) {
    print_study(*material);
  } else if (json) {
    std::cout << print_material(command.name) << "\n";
  } else {
    print_facts(*material);
  }
  return exit_code::done;
}

}  // namespace repose::server
