#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string>
#include <unistd.h>
#include <utility>

#include "server/cli/commands.hpp"
#include "server/cli/diagnosis_text.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/input.hpp"
#include "server/cli/interrupt.hpp"
#include "server/cli/next_command.hpp"
#include "server/json/missing_effect_json.hpp"
#include "server/json/missing_effect_request.hpp"
#include "server/json/place.hpp"
#include "server/json/report_json.hpp"
#include "server/service.hpp"

namespace repose::server {
namespace {

ServiceOptions look_into(const std::filesystem::path& database) {
  ServiceOptions options;
  options.database = database;
  options.read_only = true;
  return options;
}

/// "tilting_box.static_angle=0.1" -> the observable and its spread between codes.
engine::Result<calibrator::Tolerances, InputError> read_tolerances(
    const std::vector<std::string>& texts) {
  calibrator::Tolerances tolerances;
  for (const std::string& text : texts) {
    const auto wrong = [&](const std::string& what) {
      return engine::Unexpected{InputError{"--tolerance " + text + ": " + what, {}}};
    };
    const std::size_t split = text.find('=');
    char* end = nullptr;
    const double spread =
        split == std::string::npos ? -1.0 : std::strtod(text.c_str() + split + 1, &end);
    if (end == nullptr || end == text.c_str() + split + 1 || *end != '\0' || !(spread >= 0.0) ||
        spread > 1.0) {
      return wrong(
          "write EXPERIMENT.OBSERVABLE=SHARE with a share from 0 to 1, for instance "
          "tilting_box.static_angle=0.1");
    }
    const std::string name = text.substr(0, split);
    const std::vector<std::string>& names = observable_names();
    if (std::ranges::find(names, name) == names.end()) {
      return wrong("there is no such observable" + did_you_mean(name, names) + "; there are " +
                   listed(names));
    }
    if (!tolerances.emplace(name, spread).second) return wrong(name + " has been given before");
  }
  return tolerances;
}

int refuse(const Refusal& refusal, bool json) {
  return report_error({refusal.message, refusal.problems}, json);
}

bool is_there(const std::filesystem::path& database) {
  if (std::filesystem::exists(database)) return true;
  std::cerr << "repose: there is no database " << database.string()
            << "; --db FILE or REPOSE_DB names another\n";
  return false;
}

}  // namespace

int compare_command(const MissingEffectCommand& command) {
  const bool json = command.form == Form::json;
  const auto tolerances = read_tolerances(command.tolerances);
  if (!tolerances) return report_error(tolerances.error(), json);
  if (!is_there(command.database)) return exit_code::misused;
  const Service service(look_into(command.database));
  const auto answer = service.compare(command.id, *tolerances);
  if (!answer) return refuse(answer.error(), json);
  if (json) {
    std::cout << *answer << "\n";
    return exit_code::done;
  }
  const auto document = service.calibration(command.id);
  if (!document) return refuse(document.error(), json);
  std::cout << print_comparison_text(*document, *answer);
  return exit_code::done;
}

int diagnose_command(const MissingEffectCommand& command) {
  const bool json = command.form == Form::json;
  const auto tolerances = read_tolerances(command.tolerances);
  if (!tolerances) return report_error(tolerances.error(), json);
  if (!is_there(command.database)) return exit_code::misused;
  ServiceOptions options;
  options.database = command.database;
  options.workers = command.workers;
  options.program = own_program();
  const Interrupt interrupt;
  Service service(options);
  DiagnosisEvents events;
  std::string stage;
  events.progress = [&](const calibrator::DiagnosisProgress& progress) {
    stage = progress.stage;
    std::cerr << "repose: " << stage << ", after " << progress.evaluations_done << " evaluations\n";
  };
  const bool terminal = isatty(STDERR_FILENO) == 1;
  events.trial = [&](std::size_t done, std::size_t all, bool) {
    if (terminal) std::cerr << "\r  " << done << " of " << all << " runs" << std::flush;
    if (terminal && done == all) std::cerr << "\n";
  };
  const auto answer = service.diagnose(command.id, *tolerances, interrupt.token(), events);
  if (!answer) return refuse(answer.error(), json);
  if (interrupt.happened()) {
    std::cerr << "repose: stopped. Every finished run is kept; the same command takes it up.\n";
    const auto stopped = parse_diagnosis_record(*answer);
    if (stopped && stopped->state == "queued") {
      std::cerr << queued_text(stopped->id, Cancelled::diagnosis, command.database);
    }
    return exit_code::interrupted;
  }
  if (json) {
    std::cout << *answer << "\n";
  } else {
    const auto document = service.calibration(command.id);
    if (!document) return refuse(document.error(), json);
    std::cout << print_diagnosis_text(*document, *answer, command.database);
  }
  return exit_code::done;
}

int extend_command(const MissingEffectCommand& command) {
  const bool json = command.form == Form::json;
  if (!is_there(command.database)) return exit_code::misused;
  std::string study;
  {
    const Service service(look_into(command.database));
    auto answer = service.extension_study(command.id, command.effect);
    if (!answer) return refuse(answer.error(), json);
    study = *std::move(answer);
  }
  return calibrate_text(
      {.study = "the extended study",
       .asked_as = {"extend", std::to_string(command.id), "--effect", command.effect},
       .database = command.database,
       .workers = command.workers,
       .report = command.report,
       .pictures = command.pictures,
       .form = command.form},
      study);
}

}  // namespace repose::server
