#include "server/cli/summary.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

#include "engine/evaluate.hpp"
#include "server/cli/input.hpp"
#include "server/cli/text_table.hpp"
#include "server/report/fit_line.hpp"
#include "server/report/frame_files.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"
#include "server/report/portraits.hpp"
#include "server/report/report.hpp"
#include "server/report/words.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Fit;
using calibrator::Measurement;

namespace {

std::string measurement_table(const Calibration& calibration, const Fit& fit) {
  TextTable table({"measurement", "measured", "predicted", "difference", "z"});
  for (const FitLine& line : lines_of(calibration, fit)) {
    const Measurement& measurement = line.measured.front();
    std::string label = line_label(line.measured);
    const std::string settings = distinction_label(calibration.measurements, measurement);
    if (!settings.empty() && !line.is_curve()) label += " (" + settings + ")";
    if (held_out(measurement)) label += " (held out)";
    table.row(
        {label, measured_text(line), predicted_text(line), difference_text(line), z_text(line)});
  }
  return table.str();
}

std::string parameter_table(const Calibration& calibration, const Fit& fit) {
  TextTable table({"free parameter", "best", "95 % interval", ""});
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const calibrator::FittedParameter& fitted = fit.parameters[i];
    const engine::Unit& unit = calibration.free.at(i).unit;
    const auto shown = [&](double value) { return number_text(value / unit.factor, 3); };
    table.row({engine::to_string(fitted.key),
               shown(fitted.value) + unit_suffix(unit),
               shown(fitted.lower) + " to " + shown(fitted.upper),
               fitted.determined ? "determined" : "not determined"});
  }
  return table.str();
}

}  // namespace

std::string print_summary(const CalibrationDocument& document) {
  std::string text = "Calibration " + std::to_string(document.id) + ": " + document.name + " (" +
                     document.state + ")\n";
  if (!document.error.empty()) text += document.error + "\n";
  if (!document.calibration || !document.fit) return text;
  const Calibration& calibration = *document.calibration;
  const Fit& fit = *document.fit;
  text += "\n" + headline(calibration, fit) + "\n\n" + measurement_table(calibration, fit) + "\n" +
          parameter_table(calibration, fit) + "\n";
  for (const std::string& sentence : learnt_sentences(calibration, fit)) text += sentence + "\n";
  text += stop_sentence(fit.stop) + "\n";
  const std::vector<std::string> next = next_sentences(calibration, fit);
  if (!next.empty()) text += "\nWhat to measure next\n";
  for (const std::string& sentence : next) text += "- " + sentence + "\n";
  if (!fit.remarks.empty()) text += "\nRemarks\n";
  for (const std::string& remark : fit.remarks) text += "- " + remark + "\n";
  text += "\n" + std::to_string(fit.evaluations) + " evaluations";
  if (fit.failed > 0) text += ", " + std::to_string(fit.failed) + " failed";
  return text + ", misfit " + number_text(fit.misfit, 3) + "\n";
}

void write_report(const CalibrationDocument& document,
                  const ReportFile& file,
                  std::stop_token stop) {
  std::vector<ReportPicture> pictures;
  const bool has_best = document.calibration && document.fit && !document.fit->best.empty();
  if (file.pictures && has_best && !stop.stop_requested()) {
    std::cerr << "repose: running the experiments once at the best set for the report's pictures "
                 "(--no-pictures skips this)\n";
    pictures = portraits(*document.calibration, *document.fit, std::move(stop));
  }
  const Provenance provenance{.program = "repose " + std::string(engine::version()),
                              .database = file.database.string(),
                              .written_at = time_now()};
  write_file(file.path, print_report(document, pictures, provenance));
}

}  // namespace repose::server
