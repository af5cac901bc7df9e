/// Arguments: how the command line is read, for commands with many of them and what they share.
#pragma once

#include <filesystem>
#include <functional>

#include <CLI/CLI.hpp>

#include "server/cli/commands.hpp"

namespace repose::server {

/// What the command line asked for; empty until a command is read.
using Work = std::function<int()>;

CLI::Option* add_database(CLI::App& command, std::filesystem::path& database);
void add_json(CLI::App& command, Form& form, const char* what);

void add_export(CLI::App& app, ExportCommand& options, Work& work);
void add_store(CLI::App& app, StoreCommand& options, Work& work);
void add_schedule(CLI::App& app, ScheduleCommand& options, Work& work);
void add_nightly(CLI::App& app, ScheduleCommand& options, Work& work);

}  // namespace repose::server
