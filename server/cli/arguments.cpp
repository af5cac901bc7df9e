#include "server/cli/arguments.hpp"

namespace repose::server {

CLI::Option* add_database(CLI::App& command, std::filesystem::path& database) {
  return command
      .add_option("--db,--database",
                  database,
                  "Database file (default: $REPOSE_DB, else repose/repose.db in "
                  "$XDG_DATA_HOME or ~/.local/share)")
      ->type_name("FILE");
}

void add_workers(CLI::App& command, unsigned& workers) {
  command.add_option("--workers", workers, "Evaluations at once (default: one a core)")
      ->check(CLI::Range(1, 4096));
}

void add_json(CLI::App& command, Form& form, const char* what) {
  command.add_flag_callback(
      "--json", [&form] { form = Form::json; }, what);
}

}  // namespace repose::server
