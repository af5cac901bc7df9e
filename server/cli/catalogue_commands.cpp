#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include "engine/catalogue.hpp"
#include "server/cli/catalogue_text.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/input.hpp"
#include "server/cli/output.hpp"
#include "server/cli/text_table.hpp"
#include "server/json/catalogue_json.hpp"
#include "server/json/place.hpp"
#include "server/json/schemas.hpp"
#include "server/report/frame_files.hpp"

namespace repose::server {

namespace fs = std::filesystem;

int catalogue_command(Form form) {
  std::cout << (form == Form::markdown ? catalogue_markdown() : print_catalogue() + "\n");
  return exit_code::done;
}

int explain_command(const std::string& name) {
  if (name.empty()) {
    TextTable table({"experiment", "which is"}, "ll");
    for (const auto& info : engine::experiment_catalogue()) {
      table.row({std::string(info.name), std::string(info.summary)});
    }
    std::cout << table.str() << "\n`repose explain NAME` says more of one.\n";
    return exit_code::done;
  }
  const engine::ExperimentInfo* info = engine::find_experiment(name);
  if (info == nullptr) return report_error(no_experiment(name), false);
  std::cout << explanation(*info);
  return exit_code::done;
}

namespace {

/// Generated schemas are renewed; those written by hand are put only where they are missing, so
/// that an older program never undoes an edit.
int write_schemas(const fs::path& folder) {
  for (const auto& [name, text] : generated_schemas()) {
    if (const auto why = make_folder((folder / name).parent_path())) {
      return report_error(*why, false);
    }
    write_file(folder / name, text);
    std::cout << (folder / name).string() << "\n";
  }
  for (const auto& [name, text] : written_schemas()) {
    if (fs::exists(folder / name)) continue;
    write_file(folder / name, text);
    std::cout << (folder / name).string() << "\n";
  }
  return exit_code::done;
}

}  // namespace

int schema_command(const SchemaCommand& command) {
  if (!command.folder.empty()) return write_schemas(command.folder);
  auto schemas = written_schemas();
  std::ranges::move(generated_schemas(), std::back_inserter(schemas));
  std::vector<std::string> names;
  for (const auto& [path, text] : schemas) {
    const std::string name = fs::path(path).filename().string();
    names.push_back(name);
    if (command.name.empty()) std::cout << name << "\n";
    if (command.name != name && command.name + ".schema.json" != name) continue;
    std::cout << text;
    return exit_code::done;
  }
  if (command.name.empty()) return exit_code::done;
  std::cerr << "repose: there is no schema '" << command.name << "'"
            << did_you_mean(command.name, names) << "; there are " << listed(names) << "\n";
  return exit_code::misused;
}

}  // namespace repose::server
