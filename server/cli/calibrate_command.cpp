#include <iostream>
#include <optional>
#include <string>
#include <unistd.h>
#include <utility>

#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/input.hpp"
#include "server/cli/interrupt.hpp"
#include "server/cli/next_command.hpp"
#include "server/cli/output.hpp"
#include "server/cli/progress.hpp"
#include "server/cli/summary.hpp"
#include "server/json/calibration_json.hpp"
#include "server/service.hpp"

namespace repose::server {

namespace {

ServiceOptions options_of(const CalibrateCommand& command) {
  ServiceOptions options;
  options.database = command.database;
  options.workers = command.workers;
  options.program = own_program();
  return options;
}

Answer<std::string> run(const CalibrateCommand& command,
                        const std::string& text,
                        const Interrupt& interrupt) {
  Service service(options_of(command));
  const auto study = service.study(text);
  if (!study) return study;
  const auto calibration = parse_calibration(*study);
  ProgressDisplay display(*calibration, std::cerr, isatty(STDERR_FILENO) == 1);
  CalibrationEvents events;
  events.progress = [&](const calibrator::Progress& progress) { display.progress(progress); };
  events.trial = [&](std::size_t done, std::size_t all, bool stored) {
    display.trial(done, all, stored);
  };
  auto answer = service.calibrate(text, interrupt.token(), events);
  display.finish();
  return answer;
}

std::filesystem::path report_path(const CalibrateCommand& command, std::int64_t id) {
  if (!command.report.empty()) return command.report;
  return command.database.parent_path() / report_name(command.database, id);
}

/// What is wrong with the file that the report is to go to: said before hours of work, not after.
std::optional<InputError> objection_to_report(const CalibrateCommand& command) {
  if (command.report.empty()) return std::nullopt;  // where the database can be written, it can
  return objection_to_file(command.report);
}

int stopped(const CalibrateCommand& command, std::int64_t id) {
  std::cerr << "repose: stopped. Every finished evaluation is kept in " << command.database.string()
            << "; the same command takes the calibration up where it was:\n  "
            << resume_words(command) << "\n"
            << queued_text(id, Cancelled::calibration, command.database);
  return exit_code::interrupted;
}

}  // namespace

int calibrate_text(const CalibrateCommand& command, const std::string& study) {
  const bool json = command.form == Form::json;
  if (const auto why = objection_to_report(command)) return report_error(*why, json);
  const Interrupt interrupt;
  const auto answer = run(command, study, interrupt);
  if (!answer) {
    return report_error(
        {command.study.string() + ": " + answer.error().message, answer.error().problems}, json);
  }
  const auto document = parse_document(*answer);
  if (json) std::cout << *answer << "\n";
  if (!document) {
    std::cerr << "repose: " << document.error() << "\n";
    return exit_code::failed;
  }
  if (document->state == "queued") return stopped(command, document->id);
  if (!json) std::cout << print_summary(*document);
  if (!document->fit) {
    std::cerr << "repose: calibration " << document->id << " has no fit"
              << (document->error.empty() ? "" : ": " + document->error) << "\n";
    return exit_code::failed;
  }
  const auto path = report_path(command, document->id);
  write_report(*document, {path, command.database, command.pictures}, interrupt.token());
  (json ? std::cerr : std::cout) << "\nReport: " << path.string() << "\nCalibration "
                                 << document->id << " in " << command.database.string() << "\n";
  if (!json) std::cout << after_fit(*document, command.database);
  return document->fit->stop == calibrator::StopReason::failed ? exit_code::failed
                                                               : exit_code::done;
}

int calibrate_command(const CalibrateCommand& command) {
  const auto text = read_text(command.study);
  if (!text) return report_error(text.error(), command.form == Form::json);
  return calibrate_text(command, *text);
}

}  // namespace repose::server
