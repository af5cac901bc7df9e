/// Input: files and studies that a command is given, and where its database lies.
#pragma once

#include <filesystem>
#include <string>

#include "calibrator/calibration.hpp"
#include "engine/result.hpp"
#include "server/json/problem.hpp"

namespace repose::server {

/// Bad input: what to tell, and its parts where there are any.
struct InputError {
  std::string message;
  Problems problems;
};

/// The whole of a file; "-" is standard input.
engine::Result<std::string, InputError> read_text(const std::filesystem::path& path);

/// A study that names nothing which is kept elsewhere.
engine::Result<calibrator::Calibration, InputError> read_study(const std::filesystem::path& path);

/// Prints to standard error; as a JSON object to standard output too where one is awaited there.
/// Returns the exit code.
int report_error(const InputError& error, bool json);

/// What is wrong with the name of an experiment that there is not.
InputError no_experiment(const std::string& name);

/// Makes the folder of a database where it can; where it cannot, the database cannot be opened, and
/// that is told in words of our own.
void make_folder_of(const std::filesystem::path& database);

/// $REPOSE_DB, else repose/repose.db in $XDG_DATA_HOME or ~/.local/share. The folder is made.
std::filesystem::path default_database();

/// This program, which starts itself to answer single trials: the file that runs, not what has been
/// put in its place since.
std::filesystem::path own_program();

/// The time now, ISO 8601, UTC.
std::string time_now();

}  // namespace repose::server
