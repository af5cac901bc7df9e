#include "server/cli/arguments.hpp"

namespace repose::server {

void add_schedule(CLI::App& app, ScheduleCommand& options, Work& work) {
  CLI::App& group = *app.add_subcommand("schedule", "Calibrate again at certain times");
  group.require_subcommand(1);
  const auto add =
      [&](const char* name, const char* what, int (*run)(const ScheduleCommand&)) -> CLI::App& {
    CLI::App& command = *group.add_subcommand(name, what);
    add_database(command, options.database);
    add_json(command, options.form, "One JSON object on standard output");
    does(command, options, run, work);
    return command;
  };
  CLI::App& make = add("add", "Add a schedule, or replace one", schedule_add_command);
  make.add_option("study", options.study, "Study document")->required()->type_name("STUDY.json");
  make.add_option("--cron", options.cron, "Minute, hour, day, month, weekday; as crontab(5)")
      ->default_str("30 2 * * *");
  make.add_option("--time-zone", options.time_zone, "IANA name, such as Europe/Berlin")
      ->default_str("UTC");
  make.add_option("--name", options.name, "Name (default: the study's)");
  make.add_option("--jitter-minutes", options.jitter_minutes, "Begin up to that much later")
      ->default_str("0");
  make.add_option(
          "--catch-up-hours", options.catch_up_hours, "How late a missed night is still run")
      ->default_str("12");
  make.add_option(
      "--start-from", options.calibration, "Calibration whose fit is in force at first");
  make.add_option("--replace",
                  options.id,
                  "Schedule to put this one in the place of; what is not given stays as it has it")
      ->check(CLI::PositiveNumber);
  add("list", "List the schedules", schedule_list_command);
  const auto add_with_id =
      [&](const char* name, const char* what, int (*run)(const ScheduleCommand&)) -> CLI::App& {
    CLI::App& command = add(name, what, run);
    command.add_option("id", options.id, "Schedule")->required();
    return command;
  };
  add_with_id("show", "Print where a schedule stands, and the fit in force", schedule_show_command);
  add_with_id("remove", "Begin no more nights; the history stays", schedule_remove_command);
  add_with_id("history", "List its nights, newest first", schedule_history_command)
      .add_option("--limit", options.limit, "At most so many")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  add_with_id("promote", "Put another of its fits in force", schedule_promote_command)
      .add_option("calibration", options.calibration, "A candidate, or an earlier one")
      ->required();
}

void add_nightly(CLI::App& app, ScheduleCommand& options, Work& work) {
  CLI::App& command =
      *app.add_subcommand("nightly", "Run the nights that are due, for systemd timers and cron");
  bool& once = options.once;
  command.add_flag("--once", once, "Look at the clock once, and end when the nights have ended")
      ->required();
  command.add_flag("--all", options.all, "A night of every schedule, due or not");
  add_database(command, options.database);
  add_workers(command, options.workers);
  add_json(command, options.form, "The schedules on standard output, with their last nights");
  command.footer(
      "Not beside a running `repose serve`, which runs its nights itself: they would want the\n"
      "same database. server/deploy/ has a unit and a timer.");
  does(command, options, nightly_command, work);
}

}  // namespace repose::server
