#include <iostream>

#include "db/backup.hpp"
#include "server/access/secret.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"

namespace repose::server {

int backup_command(const StoreCommand& command) {
  db::back_up(command.database, command.file);
  std::cout << command.file.string() << "\n";
  return exit_code::done;
}

int restore_command(const StoreCommand& command) {
  const auto kept = db::restore(command.file, command.database);
  std::cout << command.database.string() << "\n";
  if (!kept.empty()) std::cerr << "repose: what was there is now " << kept.string() << "\n";
  return exit_code::done;
}

int doctor_command(const StoreCommand& command) {
  const auto problems = db::examine(command.database, digest);
  for (const std::string& problem : problems) std::cout << problem << "\n";
  if (!problems.empty()) return exit_code::failed;
  std::cout << command.database.string() << " is sound\n";
  return exit_code::done;
}

}  // namespace repose::server
