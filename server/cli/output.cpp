#include "server/cli/output.hpp"

#include <cerrno>
#include <string>
#include <system_error>
#include <unistd.h>

namespace repose::server {

namespace fs = std::filesystem;

namespace {

InputError unwritable(const fs::path& path, const std::string& why) {
  return {path.string() + " cannot be written: " + why, {}};
}

bool may(const fs::path& path, int what) { return access(path.c_str(), what) == 0; }

}  // namespace

fs::path report_name(const fs::path& database, std::int64_t calibration) {
  const fs::path name = database.extension() == ".db" ? database.stem() : database.filename();
  return name.string() + "-report-" + std::to_string(calibration) + ".html";
}

std::optional<InputError> objection_to_file(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) {
    return InputError{file.string() + " is a folder; name a file in it", {}};
  }
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored)) {
    return unwritable(file, "there is no folder " + folder.string());
  }
  if (may(file, F_OK) ? may(file, W_OK) : may(folder, W_OK | X_OK)) return std::nullopt;
  return unwritable(file, std::generic_category().message(errno));
}

std::optional<InputError> make_folder(const fs::path& folder) {
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (problem) {
    return InputError{"cannot make the folder " + folder.string() + ": " + problem.message(), {}};
  }
  if (may(folder, W_OK | X_OK)) return std::nullopt;
  return unwritable(folder, std::generic_category().message(errno));
}

}  // namespace repose::server
