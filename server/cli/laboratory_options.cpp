#include "server/cli/laboratory_options.hpp"

#include <CLI/CLI.hpp>

#include "server/cli/input.hpp"

namespace repose::server {

namespace {

constexpr const char* kept_footer =
    "Every finished run is kept in the database: the same command goes on where an interrupted\n"
    "one was.";

void add_workers(CLI::App& command, LaboratoryCommand& options) {
  command
      .add_option("--db,--database",
                  options.database,
                  "Database file (default: $REPOSE_DB, else repose/repose.db in $XDG_DATA_HOME or "
                  "~/.local/share)")
      ->type_name("FILE");
  command.add_option("--workers", options.workers, "Runs at once (default: one a core)")
      ->check(CLI::Range(1, 4096));
  command.add_flag_callback(
      "--json", [&options] { options.form = Form::json; }, "JSON on standard output");
  command.footer(kept_footer);
}

void use_default_database(LaboratoryCommand& options) {
  if (options.database.empty()) options.database = default_database();
}

}  // namespace

void add_laboratory(CLI::App& app,
                    CLI::App& bench,
                    LaboratoryOptions& options,
                    std::function<int()>& work) {
  CLI::App& costs = *bench.add_subcommand(
      "laboratory", "What each experiment takes of one core, at draft and standard fidelity");
  costs.add_flag_callback(
      "--json", [&options] { options.costs = Form::json; }, "JSON on standard output");
  costs.callback([&] { work = [&] { return bench_laboratory_command(options.costs); }; });

  CLI::App& fidelity = *bench.add_subcommand(
      "fidelity", "How readings at draft fidelity lie to those at standard, over spread grains");
  fidelity.add_option("--sets", options.fidelity.sets, "Grains that are tried")
      ->capture_default_str()
      ->check(CLI::Range(2, 1000));
  add_workers(fidelity, options.fidelity);
  fidelity.callback([&] {
    work = [&] {
      use_default_database(options.fidelity);
      return bench_fidelity_command(options.fidelity);
    };
  });

  CLI::App& trends = *app.add_subcommand(
      "trends", "Plot every observable of the laboratory under every parameter");
  trends.add_option("--output", options.trends.output, "Folder for trends.html and trends.json")
      ->type_name("FOLDER")
      ->default_str("the working folder");
  add_workers(trends, options.trends);
  trends.callback([&] {
    work = [&] {
      use_default_database(options.trends);
      return trends_command(options.trends);
    };
  });

  CLI::App& explain = *app.add_subcommand("explain", "Say and draw what a virtual experiment does");
  explain.add_option("experiment", options.explained, "Which; without it they are listed");
  explain.callback([&] { work = [&] { return explain_command(options.explained); }; });
}

}  // namespace repose::server
