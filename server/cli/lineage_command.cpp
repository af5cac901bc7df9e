#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>
#include <utility>

#include "engine/evaluate.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/input.hpp"
#include "server/cli/output.hpp"
#include "server/cli/text_table.hpp"
#include "server/jobs/clock.hpp"
#include "server/json/diagnosis_json.hpp"
#include "server/json/lineage_json.hpp"
#include "server/json/missing_effect_json.hpp"
#include "server/json/text.hpp"
#include "server/report/diagnosis_words.hpp"
#include "server/report/frame_files.hpp"
#include "server/report/lineage_report.hpp"
#include "server/report/number_text.hpp"
#include "server/service.hpp"

namespace repose::server {

namespace {

std::string z_text(double z) { return std::isfinite(z) ? fixed_text(z, 2) : "-"; }

/// The tree, each model below and right of the one that it extends.
std::string print_lineage_text(const std::vector<LineageItem>& items) {
  TextTable table(
      {"model", "calibration", "state", "misfit", "p", "fitted", "held out", "diagnosis"},
      "lrlrrrrl");
  std::map<std::int64_t, std::size_t> depth;
  for (const LineageItem& item : items) {
    depth[item.calibration] = item.parent ? depth[*item.parent] + 1 : 0;
    std::vector<std::string> row{std::string(2 * depth[item.calibration], ' ') +
                                     (item.parent ? "+ " + item.effect : item.name),
                                 std::to_string(item.calibration),
                                 item.state};
    if (item.quality) {
      const FitQuality& fit = *item.quality;
      row.insert(row.end(),
                 {fixed_text(fit.misfit, 1) + " / " + fixed_text(fit.freedom, 0),
                  chance_text(fit.p),
                  z_text(fit.fitted_z),
                  z_text(fit.held_out_z)});
    } else {
      row.insert(row.end(), {"-", "-", "-", "-"});
    }
    row.push_back(item.verdict + (item.grade.empty() ? "" : ", grade " + item.grade));
    table.row(std::move(row));
  }
  return table.str();
}

/// One model of the path with all that its report shows.
engine::Result<Generation, std::string> read_generation(const Service& service,
                                                        const LineageItem& item) {
  const auto text = service.calibration(item.calibration);
  if (!text) return engine::Unexpected{text.error().message};
  auto document = parse_document(*text);
  if (!document) return engine::Unexpected{document.error()};
  if (!document->calibration || !document->fit) {
    return engine::Unexpected{"calibration " + std::to_string(item.calibration) + " has no fit"};
  }
  Generation generation{*std::move(document), {}, {}, 0};
  generation.comparison = calibrator::compare(generation.calibration(), generation.fit());
  if (!item.diagnosis) return generation;
  const auto kept = service.diagnosis(*item.diagnosis);
  if (!kept) return engine::Unexpected{kept.error().message};
  const auto record = parse_diagnosis_record(*kept);
  if (!record) return engine::Unexpected{record.error()};
  auto diagnosis = parse_diagnosis(generation.calibration(), record->result);
  if (!diagnosis) return engine::Unexpected{diagnosis.error()};
  generation.diagnosis = *std::move(diagnosis);
  generation.diagnosis_id = record->id;
  return generation;
}

int write_lineage_report(const Service& service,
                         const LineageCommand& command,
                         const std::vector<LineageItem>& items) {
  if (const auto why = objection_to_file(command.report)) return report_error(*why, false);
  Lineage lineage;
  for (const LineageItem& item : path_through(items, command.id)) {
    auto generation = read_generation(service, item);
    if (!generation) return report_error({generation.error(), {}}, false);
    lineage.push_back(*std::move(generation));
  }
  if (lineage.empty()) {
    return report_error(
        {"calibration " + std::to_string(command.id) + " is not finished: it has no fit to show",
         {}},
        false);
  }
  const Provenance provenance{.program = "repose " + std::string(engine::version()),
                              .database = command.database.string(),
                              .written_at = print_time(microseconds_now())};
  write_file(command.report, print_lineage_report(lineage, provenance));
  std::cout << command.report.string() << "\n";
  return exit_code::done;
}

}  // namespace

int lineage_command(const LineageCommand& command) {
  const bool json = command.form == Form::json;
  if (!std::filesystem::exists(command.database)) {
    return report_error({"there is no database " + command.database.string() +
                             "; --db FILE or REPOSE_DB names another",
                         {}},
                        json);
  }
  ServiceOptions options;
  options.database = command.database;
  options.read_only = true;
  const Service service(options);
  const auto answer = service.lineage(command.id);
  if (!answer) return report_error({answer.error().message, answer.error().problems}, json);
  if (json) {
    std::cout << *answer << "\n";
    return exit_code::done;
  }
  const auto items = parse_lineage(*answer);
  if (!items) return report_error({items.error(), {}}, json);
  if (!command.report.empty()) return write_lineage_report(service, command, *items);
  std::cout << print_lineage_text(*items);
  return exit_code::done;
}

}  // namespace repose::server
