#include "server/cli/input.hpp"

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "engine/catalogue.hpp"
#include "server/cli/exit_code.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/place.hpp"
#include "server/json/replicates_json.hpp"

namespace repose::server {

using engine::Result;
using engine::Unexpected;

namespace fs = std::filesystem;

Result<std::string, InputError> read_text(const fs::path& path) {
  if (path == "-") {
    return std::string(std::istreambuf_iterator<char>(std::cin), std::istreambuf_iterator<char>());
  }
  if (fs::is_directory(path)) {
    return Unexpected{InputError{path.string() + " is a folder; name a file in it", {}}};
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    const bool there = fs::exists(path);
    return Unexpected{InputError{path.string() + (there ? " cannot be read; check its permissions"
                                                        : " does not exist; name a study file, or "
                                                          "- for standard input"),
                                 {}}};
  }
  return std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
}

Result<calibrator::Calibration, InputError> read_study(const fs::path& path) {
  const auto text = read_text(path);
  if (!text) return Unexpected{text.error()};
  auto calibration = parse_calibration(*text);
  if (calibration) return *std::move(calibration);
  return Unexpected{InputError{path.string() + " is no study: " + counted(calibration.error()),
                               std::move(calibration).error()}};
}

int report_error(const InputError& error, bool json) {
  std::cerr << "repose: " << error.message << "\n";
  for (const Problem& problem : error.problems) {
    std::cerr << "  " << (problem.pointer.empty() ? "the document" : problem.pointer) << ": "
              << problem.message;
    if (!problem.found.empty()) std::cerr << "\n      found:   " << problem.found;
    if (!problem.allowed.empty()) std::cerr << "\n      allowed: " << problem.allowed;
    std::cerr << "\n";
  }
  if (json) std::cout << print_error(error.message, error.problems) << "\n";
  return exit_code::misused;
}

InputError no_experiment(const std::string& name) {
  std::vector<std::string_view> names;
  for (const auto& known : engine::experiment_catalogue()) names.push_back(known.name);
  return {"there is no experiment '" + name + "'" + did_you_mean(name, names) + "; there are " +
              listed(names),
          {}};
}

void make_folder_of(const fs::path& database) {
  std::error_code told_when_it_is_opened;
  if (database.has_parent_path()) {
    fs::create_directories(database.parent_path(), told_when_it_is_opened);
  }
}

fs::path default_database() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string_view(value == nullptr ? "" : value);
  };
  fs::path path = variable("REPOSE_DB");
  if (path.empty()) {
    fs::path data = variable("XDG_DATA_HOME");
    if (data.empty()) data = fs::path(variable("HOME")) / ".local" / "share";
    path = data / "repose" / "repose.db";
  }
  make_folder_of(path);
  return path;
}

fs::path own_program() { return "/proc/self/exe"; }

std::string time_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  const std::size_t length = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return {text, length};
}

}  // namespace repose::server
