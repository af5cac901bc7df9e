/// Arguments: how the command line is read, for commands with many of them and what they share.
#pragma once

#include <filesystem>
#include <functional>

#include <CLI/CLI.hpp>

#include "server/cli/commands.hpp"
#include "server/cli/input.hpp"

namespace repose::server {

/// What the command line asked for; empty until a command is read.
using Work = std::function<int()>;

CLI::Option* add_database(CLI::App& command, std::filesystem::path& database);
void add_workers(CLI::App& command, unsigned& workers);
void add_json(CLI::App& command, Form& form, const char* what);

/// The command does that, with the usual database where none is named.
template <class Options>
void does(CLI::App& command, Options& options, int (*run)(const Options&), Work& work) {
  command.callback([&options, &work, run] {
    work = [&options, run] {
      if (options.database.empty()) options.database = default_database();
      return run(options);
    };
  });
}

void add_export(CLI::App& app, ExportCommand& options, Work& work);
void add_store(CLI::App& app, StoreCommand& options, Work& work);
void add_schedule(CLI::App& app, ScheduleCommand& options, Work& work);
void add_nightly(CLI::App& app, ScheduleCommand& options, Work& work);

void add_calibrate(CLI::App& app, CalibrateCommand& options, Work& work);
void add_missing_effect(CLI::App& app, MissingEffectCommand& options, Work& work);
void add_lineage(CLI::App& app, LineageCommand& options, Work& work);
void add_report(CLI::App& app, ReportCommand& options, Work& work);
void add_list(CLI::App& app, ListCommand& options, Work& work);
void add_show(CLI::App& app, ShowCommand& options, Work& work);
void add_cancel(CLI::App& app, CancelCommand& options, Work& work);

void add_serve(CLI::App& app, ServeCommand& options, Work& work);
void add_token(CLI::App& app, TokenCommand& options, Work& work);

void add_bench(CLI::App& app,
               BenchCommand& options,
               BenchEffectsCommand& effects,
               BenchCalibratorCommand& calibrator,
               LaboratoryOptions& laboratory,
               Work& work);
void add_study(CLI::App& app, StudyCommand& options, Work& work);

/// bench laboratory, bench fidelity, trends, explain; `bench` is the command that measures.
void add_laboratory(CLI::App& app, CLI::App& bench, LaboratoryOptions& options, Work& work);

}  // namespace repose::server
