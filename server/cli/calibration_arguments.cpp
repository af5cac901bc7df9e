// The commands of calibrations.
#include "server/cli/arguments.hpp"

namespace repose::server {

namespace {

constexpr const char* calibrate_footer =
    "Ctrl-C stops; the same command takes the calibration up where it was. Progress goes to\n"
    "standard error: a display that renews itself on a terminal, a line a batch elsewhere.";

constexpr const char* report_help =
    "Report (default: DATABASE-report-ID.html beside the database, of r.db r-report-1.html)";

}  // namespace

void add_calibrate(CLI::App& app, CalibrateCommand& options, Work& work) {
  CLI::App& command = *app.add_subcommand("calibrate", "Calibrate a study and write its report");
  command.add_option("study", options.study, "Study document; - is standard input")
      ->required()
      ->type_name("STUDY.json");
  add_database(command, options.database);
  add_workers(command, options.workers);
  command.add_option("--report", options.report, report_help)->type_name("FILE");
  command.add_flag_callback(
      "--no-pictures",
      [&options] { options.pictures = false; },
      "Do not run the best set once more for the report's pictures");
  add_json(command, options.form, "The calibration's document on standard output");
  command.footer(calibrate_footer);
  does(command, options, calibrate_command, work);
}

void add_missing_effect(CLI::App& app, MissingEffectCommand& options, Work& work) {
  const auto add =
      [&](const char* name, const char* what, int (*run)(const MissingEffectCommand&)) {
        CLI::App& command = *app.add_subcommand(name, what);
        command.add_option("id", options.id, "Calibration")->required();
        add_database(command, options.database);
        add_json(command, options.form, "One JSON object on standard output");
        does(command, options, run, work);
        return &command;
      };
  const auto add_tolerance = [&](CLI::App& command) {
    command
        .add_option("--tolerance",
                    options.tolerances,
                    "How closely codes agree on an observable, in place of the catalogue's share")
        ->type_name("EXPERIMENT.OBSERVABLE=SHARE")
        ->expected(1)
        ->take_all();
  };
  add_tolerance(
      *add("compare", "Where a calibrated model misses its measurements", compare_command));
  CLI::App& diagnose =
      *add("diagnose", "Which physical effect a calibrated model lacks", diagnose_command);
  add_tolerance(diagnose);
  add_workers(diagnose, options.workers);
  CLI::App& extend = *add("extend", "Add an effect to a model and calibrate it", extend_command);
  extend.add_option("--effect", options.effect, "Which; `repose diagnose` names them")->required();
  add_workers(extend, options.workers);
  extend.add_option("--report", options.report, report_help)->type_name("FILE");
  extend.add_flag_callback(
      "--no-pictures", [&options] { options.pictures = false; }, "No pictures in the report");
}

void add_lineage(CLI::App& app, LineageCommand& options, Work& work) {
  CLI::App& command =
      *app.add_subcommand("lineage", "Models that add effects to one another, before and after");
  command.add_option("id", options.id, "Calibration; any of them")->required();
  add_database(command, options.database);
  command.add_option("--report", options.report, "Write their HTML report there")
      ->type_name("FILE");
  add_json(command, options.form, "One JSON object on standard output");
  does(command, options, lineage_command, work);
}

void add_report(CLI::App& app, ReportCommand& options, Work& work) {
  CLI::App& command = *app.add_subcommand("report", "Write the HTML report of a calibration");
  command.add_option("id", options.id, "Calibration")->required();
  add_database(command, options.database);
  command
      .add_option("--output",
                  options.output,
                  "Report (default: DATABASE-report-ID.html, of r.db r-report-1.html)")
      ->type_name("FILE");
  command.add_flag_callback(
      "--no-pictures",
      [&options] { options.pictures = false; },
      "Do not run the best set once more for the report's pictures");
  does(command, options, report_command, work);
}

void add_list(CLI::App& app, ListCommand& options, Work& work) {
  CLI::App& command = *app.add_subcommand("list", "List the calibrations, newest first");
  add_database(command, options.database);
  command.add_option("--limit", options.limit, "At most so many")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  add_json(command, options.form, "One JSON object on standard output");
  does(command, options, list_command, work);
}

void add_show(CLI::App& app, ShowCommand& options, Work& work) {
  CLI::App& command = *app.add_subcommand("show", "Print the answer of a calibration");
  command.add_option("id", options.id, "Calibration")->required();
  add_database(command, options.database);
  add_json(command, options.form, "The calibration's document on standard output");
  does(command, options, show_command, work);
}

void add_cancel(CLI::App& app, CancelCommand& options, Work& work) {
  CLI::App& command = *app.add_subcommand(
      "cancel", "End a calibration that is queued, so that nobody goes on with it");
  command.add_option("id", options.id, "Calibration")->required();
  command.add_flag_callback(
      "--diagnosis",
      [&options] { options.what = Cancelled::diagnosis; },
      "The number is that of a diagnosis");
  add_database(command, options.database);
  add_json(command, options.form, "Its document on standard output");
  command.footer("What a running service works on is cancelled over HTTP, with DELETE.");
  does(command, options, cancel_command, work);
}

}  // namespace repose::server
