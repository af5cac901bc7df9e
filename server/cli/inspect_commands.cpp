#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/input.hpp"
#include "server/cli/interrupt.hpp"
#include "server/cli/next_command.hpp"
#include "server/cli/output.hpp"
#include "server/cli/summary.hpp"
#include "server/cli/text_table.hpp"
#include "server/json/report_json.hpp"
#include "server/service.hpp"

namespace repose::server {

namespace {

/// Nothing, with a word on standard error, where there is no database to look into.
bool database_is_there(const std::filesystem::path& path) {
  if (std::filesystem::exists(path)) return true;
  std::cerr << "repose: there is no database " << path.string()
            << "; --db FILE or REPOSE_DB names another, `repose calibrate` makes one\n";
  return false;
}

/// The text of a calibration's document.
std::optional<std::string> find(std::int64_t id, const std::filesystem::path& database) {
  if (!database_is_there(database)) return std::nullopt;
  ServiceOptions options;
  options.database = database;
  options.read_only = true;
  const Service service(options);
  auto answer = service.calibration(id);
  if (answer) return *std::move(answer);
  std::cerr << "repose: " << answer.error().message << "; `repose list` shows those there are\n";
  return std::nullopt;
}

std::optional<CalibrationDocument> read(const std::string& text) {
  auto document = parse_document(text);
  if (document) return *std::move(document);
  std::cerr << "repose: " << document.error() << "\n";
  return std::nullopt;
}

}  // namespace

int report_command(const ReportCommand& command) {
  const auto text = find(command.id, command.database);
  if (!text) return exit_code::misused;
  const auto document = read(*text);
  if (!document) return exit_code::failed;
  const auto path =
      command.output.empty() ? report_name(command.database, command.id) : command.output;
  if (const auto why = objection_to_file(path)) return report_error(*why, false);
  const Interrupt interrupt;
  write_report(*document, {path, command.database, command.pictures}, interrupt.token());
  if (interrupt.happened()) {
    std::cerr << "repose: stopped; the report has no pictures\n";
  }
  std::cout << path.string() << "\n";
  return interrupt.happened() ? exit_code::interrupted : exit_code::done;
}

int export_command(const ExportCommand& command) {
  if (!database_is_there(command.database)) return exit_code::misused;
  ServiceOptions options;
  options.database = command.database;
  options.read_only = true;
  const auto answer = Service(options).export_fit(command.id, command.format);
  if (!answer) return report_error({answer.error().message, {}}, false);
  std::cout << *answer;
  return exit_code::done;
}

int list_command(const ListCommand& command) {
  if (!database_is_there(command.database)) return exit_code::misused;
  ServiceOptions options;
  options.database = command.database;
  options.read_only = true;
  const Service service(options);
  const std::string text = service.calibrations(command.limit, std::nullopt).document;
  if (command.form == Form::json) {
    std::cout << text << "\n";
    return exit_code::done;
  }
  TextTable table({"name", "id", "state", "created"});
  for (const CalibrationItem& item : parse_items(text)) {
    table.row({item.name, std::to_string(item.id), item.state, item.created_at});
  }
  std::cout << table.str();
  return exit_code::done;
}

int show_command(const ShowCommand& command) {
  const auto text = find(command.id, command.database);
  if (!text) return exit_code::misused;
  if (command.form == Form::json) {
    std::cout << *text << "\n";
    return exit_code::done;
  }
  const auto document = read(*text);
  if (!document) return exit_code::failed;
  std::cout << print_summary(*document) << after_fit(*document, command.database);
  if (document->state == "queued") {
    std::cout << queued_text(command.id, Cancelled::calibration, command.database);
  }
  return exit_code::done;
}

int cancel_command(const CancelCommand& command) {
  if (!database_is_there(command.database)) return exit_code::misused;
  ServiceOptions options;
  options.database = command.database;
  Service service(options);
  const bool calibration = command.what == Cancelled::calibration;
  const auto answer =
      calibration ? service.cancel(command.id) : service.cancel_diagnosis(command.id);
  const bool json = command.form == Form::json;
  if (!answer) return report_error({answer.error().message, answer.error().problems}, json);
  if (json) {
    std::cout << *answer << "\n";
  } else {
    std::cout << (calibration ? "Calibration " : "Diagnosis ") << command.id
              << " is cancelled; every finished evaluation is kept\n";
  }
  return exit_code::done;
}

}  // namespace repose::server
