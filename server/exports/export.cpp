#include "server/exports/export.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>

#include "server/json/calibration_json.hpp"
#include "server/json/fit_json.hpp"
#include "server/json/text.hpp"
#include "server/report/label.hpp"

namespace repose::server {

namespace {

/// A value in a unit, without the noise of the conversion in its last digit.
std::string in_unit_text(double value, const engine::Unit& unit) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.15g", value / unit.factor);
  return text.data();
}

std::string print_json(const ExportedFit& fit) {
  return to_text(Json{{"calibration", fit.id},
                      {"name", fit.calibration.name},
                      {"finished_at", fit.finished_at},
                      {"engine_version", fit.engine_version},
                      {"study", Json::parse(print_calibration(fit.calibration))},
                      {"fit", Json::parse(print_fit(fit.calibration, fit.fit))}},
                 2) +
         "\n";
}

/// RFC 4180; a line for each parameter of the set. Those that were not free have no interval.
std::string print_csv(const ExportedFit& fit) {
  std::string text = "field,between,value,unit,lower,upper,determined\r\n";
  for (const auto& [key, value] : fit.fit.best) {
    const engine::Unit unit = parameter_unit(fit.calibration, key);
    const std::string name = engine::to_string(key);
    const std::size_t colon = name.find(':');
    text += name.substr(0, colon) + ",";
    if (colon != std::string::npos) text += name.substr(colon + 1);
    text += "," + in_unit_text(value, unit) + "," + std::string(unit.symbol);
    const bool tied = std::ranges::count(fit.calibration.tied, key, &calibrator::Tie::key) > 0;
    std::string interval = tied ? ",,,tied" : ",,,fixed";
    for (const calibrator::FittedParameter& fitted : fit.fit.parameters) {
      if (fitted.key != key) continue;
      interval = "," + in_unit_text(fitted.lower, unit) + "," + in_unit_text(fitted.upper, unit) +
                 (fitted.determined ? ",yes" : ",no");
    }
    text += interval + "\r\n";
  }
  return text;
}

std::vector<std::string> title_of(const ExportedFit& fit) {
  std::vector<std::string> title{"\"" + fit.calibration.name + "\", calibration " +
                                     std::to_string(fit.id) + " of repose, " + fit.finished_at,
                                 "fitted, with 95 % intervals:"};
  for (const calibrator::FittedParameter& fitted : fit.fit.parameters) {
    const engine::Unit unit = parameter_unit(fit.calibration, fitted.key);
    title.push_back("  " + engine::to_string(fitted.key) + " = " +
                    in_unit_text(fitted.value, unit) + " (" + in_unit_text(fitted.lower, unit) +
                    " to " + in_unit_text(fitted.upper, unit) + ") " + std::string(unit.symbol) +
                    (fitted.determined ? "" : ", not determined by the measurements"));
  }
  return title;
}

}  // namespace

std::string exact(double value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string filled(std::string text,
                   const std::vector<std::pair<std::string_view, std::string>>& values) {
  for (const auto& [name, value] : values) {
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at)) {
      text.replace(at, name.size(), value);
      at += value.size();
    }
  }
  return text;
}

std::string comment_head(const std::vector<std::string>& title,
                         const std::vector<std::string>& unsaid,
                         std::string_view code) {
  std::string text;
  for (const std::string& line : title) {
    text += "# ";
    for (const char letter : line) text += letter == '\n' || letter == '\r' ? ' ' : letter;
    text += '\n';
  }
  if (unsaid.empty()) return text + "# Everything in the fit is said below.\n";
  text += "# NOT said below, because " + std::string(code) +
          " cannot or this file does not: results will differ.\n";
  for (const std::string& line : unsaid) text += "#   " + line + "\n";
  return text;
}

std::string print_export(const ExportedFit& fit, ExportFormat format) {
  switch (format) {
    case ExportFormat::json:
      return print_json(fit);
    case ExportFormat::csv:
      return print_csv(fit);
    case ExportFormat::liggghts:
      return print_liggghts(dem_model(fit.fit.best), title_of(fit));
    case ExportFormat::lammps:
      return print_lammps(dem_model(fit.fit.best), title_of(fit));
    case ExportFormat::yade:
      return print_yade(dem_model(fit.fit.best), title_of(fit));
  }
  return {};
}

}  // namespace repose::server
