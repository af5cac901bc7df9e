#include "server/cli/arguments.hpp"

namespace repose::server {

namespace {

constexpr const char* kept_footer =
    "Every finished run is kept in the database: the same command goes on where an interrupted\n"
    "one was.";

/// A command of the laboratory whose runs are kept.
void add_kept(CLI::App& command,
              LaboratoryCommand& options,
              int (*run)(const LaboratoryCommand&),
              Work& work) {
  add_database(command, options.database);
  add_workers(command, options.workers);
  add_json(command, options.form, "JSON on standard output");
  command.footer(kept_footer);
  does(command, options, run, work);
}

}  // namespace

void add_laboratory(CLI::App& app, CLI::App& bench, LaboratoryOptions& options, Work& work) {
  CLI::App& costs = *bench.add_subcommand(
      "laboratory", "What each experiment takes of one core, at draft and standard fidelity");
  add_json(costs, options.costs, "JSON on standard output");
  costs.callback([&] { work = [&] { return bench_laboratory_command(options.costs); }; });

  CLI::App& fidelity = *bench.add_subcommand(
      "fidelity", "How readings at draft fidelity lie to those at standard, over spread grains");
  fidelity.add_option("--sets", options.fidelity.sets, "Grains that are tried")
      ->capture_default_str()
      ->check(CLI::Range(2, 1000));
  add_kept(fidelity, options.fidelity, bench_fidelity_command, work);

  CLI::App& trends = *app.add_subcommand(
      "trends", "Plot every observable of the laboratory under every parameter");
  trends.add_option("--output", options.trends.output, "Folder for trends.html and trends.json")
      ->type_name("FOLDER")
      ->default_str("the working folder");
  add_kept(trends, options.trends, trends_command, work);

  CLI::App& explain = *app.add_subcommand("explain", "Say and draw what a virtual experiment does");
  explain.add_option("experiment", options.explained, "Which; without it they are listed");
  explain.callback([&] { work = [&] { return explain_command(options.explained); }; });
}

}  // namespace repose::server
