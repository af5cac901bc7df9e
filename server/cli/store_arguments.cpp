#include "server/cli/arguments.hpp"
#include "server/exports/export.hpp"

namespace repose::server {

void add_export(CLI::App& app, ExportCommand& options, Work& work) {
  CLI::App& command = *app.add_subcommand("export", "Print a fit for another program");
  command.add_option("id", options.id, "Calibration")->required();
  add_database(command, options.database);
  std::vector<std::string> names(export_format_names.begin(), export_format_names.end());
  command.add_option("--format", options.format, "json, csv, liggghts, lammps or yade")
      ->capture_default_str()
      ->check(CLI::IsMember(std::move(names)));
  command.footer("An input file runs as it is, and says at its top what it cannot say of the fit.");
  does(command, options, export_command, work);
}

void add_store(CLI::App& app, StoreCommand& options, Work& work) {
  const auto add = [&](const char* name, const char* what, int (*run)(const StoreCommand&)) {
    CLI::App& command = *app.add_subcommand(name, what);
    add_database(command, options.database);
    does(command, options, run, work);
    return &command;
  };
  add("backup", "Copy the database into one file, also while a service runs", backup_command)
      ->add_option("file", options.file, "Where to; must not be there yet")
      ->required();
  add("restore", "Put a backup in the place of the database", restore_command)
      ->add_option("file", options.file, "The backup")
      ->required();
  add("doctor", "Say what is wrong with the database, if anything", doctor_command);
}

}  // namespace repose::server
