#include <array>
#include <filesystem>
#include <iostream>
#include <string>

#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/input.hpp"
#include "server/cli/interrupt.hpp"
#include "server/cli/schedule_text.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/text.hpp"
#include "server/service.hpp"

namespace repose::server {

namespace {

ServiceOptions options_of(const ScheduleCommand& command, bool read_only) {
  ServiceOptions options;
  options.database = command.database;
  options.workers = command.workers;
  options.program = own_program();
  options.read_only = read_only;
  return options;
}

bool is_there(const std::filesystem::path& database) {
  if (std::filesystem::exists(database)) return true;
  std::cerr << "repose: there is no database " << database.string()
            << "; --db FILE or REPOSE_DB names another\n";
  return false;
}

/// Prints an answer in the form asked for.
int print(const ScheduleCommand& command,
          const Answer<std::string>& answer,
          std::string (*in_words)(std::string_view)) {
  const bool json = command.form == Form::json;
  if (!answer) return report_error({answer.error().message, answer.error().problems}, json);
  std::cout << (json ? *answer + "\n" : in_words(*answer));
  return exit_code::done;
}

constexpr std::array<const char*, 6> replaceable{
    "name", "cron", "time_zone", "jitter_minutes", "catch_up_hours", "start_from"};

/// What the schedule that is replaced has.
void keep_unsaid(const Json& before, Json& document) {
  for (const char* member : replaceable) {
    if (before.contains(member)) document[member] = before[member];
  }
}

/// What the command line says.
void take_said(const ScheduleCommand& command, Json& document) {
  const auto take = [&](const char* member, const auto& said) {
    if (said) document[member] = *said;
  };
  take("name", command.name);
  take("cron", command.cron);
  take("time_zone", command.time_zone);
  take("jitter_minutes", command.jitter_minutes);
  take("catch_up_hours", command.catch_up_hours);
  if (command.calibration > 0) document["start_from"] = command.calibration;
}

}  // namespace

int schedule_add_command(const ScheduleCommand& command) {
  const bool json = command.form == Form::json;
  const auto text = read_text(command.study);
  if (!text) return report_error(text.error(), json);
  Service service(options_of(command, false));
  const auto study = service.study(*text);
  if (!study) {
    return report_error(
        {command.study.string() + ": " + study.error().message, study.error().problems}, json);
  }
  Json document{
      {"name", parse_calibration(*study)->name}, {"cron", "30 2 * * *"}, {"time_zone", "UTC"}};
  if (command.id != 0) {
    const auto before = service.schedule(command.id);
    if (!before) return report_error({before.error().message, before.error().problems}, json);
    keep_unsaid(Json::parse(*before), document);
  }
  take_said(command, document);
  // As it was written: each night takes the measurements that are kept then.
  document["study"] = Json::parse(*text);
  return print(command,
               command.id == 0 ? service.add_schedule(to_text(document))
                               : service.replace_schedule(command.id, to_text(document)),
               print_schedule_text);
}

int schedule_list_command(const ScheduleCommand& command) {
  if (!is_there(command.database)) return exit_code::misused;
  const Service service(options_of(command, true));
  return print(command, service.schedules(), print_schedules_text);
}

int schedule_show_command(const ScheduleCommand& command) {
  if (!is_there(command.database)) return exit_code::misused;
  const Service service(options_of(command, true));
  return print(command, service.schedule(command.id), print_schedule_text);
}

int schedule_remove_command(const ScheduleCommand& command) {
  if (!is_there(command.database)) return exit_code::misused;
  Service service(options_of(command, false));
  return print(command, service.remove_schedule(command.id), print_schedule_text);
}

int schedule_history_command(const ScheduleCommand& command) {
  if (!is_there(command.database)) return exit_code::misused;
  const Service service(options_of(command, true));
  const Answer<Page> page = service.nights(command.id, command.limit, std::nullopt);
  return print(command,
               page ? Answer<std::string>(page->document) : engine::Unexpected{page.error()},
               print_nights_text);
}

int schedule_promote_command(const ScheduleCommand& command) {
  if (!is_there(command.database)) return exit_code::misused;
  Service service(options_of(command, false));
  return print(command,
               service.promote(command.id,
                               R"({"calibration": )" + std::to_string(command.calibration) + "}"),
               print_schedule_text);
}

int nightly_command(const ScheduleCommand& command) {
  if (!is_there(command.database)) return exit_code::misused;
  const Interrupt interrupt;
  Service service(options_of(command, false));
  const bool json = command.form == Form::json;
  CalibrationEvents events;
  events.progress = [](const calibrator::Progress& progress) {
    std::cerr << "repose: " << progress.stage << ", after " << progress.evaluations_done
              << " evaluations\n";
  };
  service.run_nights(command.all, interrupt.token(), events);
  std::cout << (json ? service.schedules() + "\n" : print_schedules_text(service.schedules()));
  if (!interrupt.happened()) return exit_code::done;
  std::cerr << "repose: stopped; the next call takes the night up where it was\n";
  return exit_code::interrupted;
}

}  // namespace repose::server
