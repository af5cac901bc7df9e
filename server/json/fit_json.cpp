#include "server/json/fit_json.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "calibrator/search_space.hpp"
#include "engine/evaluate.hpp"
#include "server/json/codec.hpp"
#include "server/json/key_json.hpp"
#include "server/json/learnt_json.hpp"
#include "server/json/parameters_json.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Fit;
using calibrator::FreeParameter;
using calibrator::HistoryPoint;
using calibrator::Measurement;
using engine::Unit;

namespace {

Json print_parameters(const Calibration& calibration, const Fit& fit) {
  Json result = Json::array();
  for (const calibrator::FittedParameter& parameter : fit.parameters) {
    const Unit unit = unit_of(calibration, parameter.key);
    Json entry = print_key(parameter.key);
    entry["value"] = in_unit(parameter.value, unit);
    entry["interval"] = {in_unit(parameter.lower, unit), in_unit(parameter.upper, unit)};
    entry["unit"] = unit.symbol;
    entry["at_bound"] = {{"lower", parameter.lower_at_bound}, {"upper", parameter.upper_at_bound}};
    entry["learnt"] = number_or_null(parameter.learnt);
    entry["determined"] = parameter.determined;
    result.push_back(std::move(entry));
  }
  return result;
}

/// What was measured, in the author's unit: the head of every row of the table.
Json print_measured(const Measurement& measurement) {
  return {{"experiment", measurement.experiment.name},
          {"settings", print_settings(measurement.experiment)},
          {"observable", measurement.observable},
          {"unit", measurement.unit.symbol},
          {"role", calibrator::role_names[static_cast<std::size_t>(measurement.role)]},
          {"measured", in_unit(measurement.value, measurement.unit)},
          {"standard_error", in_unit(measurement.standard_error, measurement.unit)},
          {"allowance", in_unit(measurement.allowance, measurement.unit)}};
}

Json print_measurements(const Calibration& calibration, const Fit& fit) {
  Json result = Json::array();
  const auto fidelity = static_cast<std::size_t>(calibration.budget.confirm_fidelity);
  for (const calibrator::Prediction& prediction : fit.predictions) {
    const Measurement& measurement = calibration.measurements.at(prediction.measurement);
    const Unit& unit = measurement.unit;
    Json row = print_measured(measurement);
    row["predicted"] = in_unit(prediction.predicted, unit);
    row["predicted_error"] = in_unit(prediction.standard_error, unit);
    row["replicates"] = prediction.replicates;
    row["scatter"] = in_unit(prediction.scatter, unit);
    row["emulated"] = in_unit(prediction.emulated, unit);
    row["emulated_deviation"] = in_unit(prediction.emulated_deviation, unit);
    row["difference"] = in_unit(prediction.predicted - measurement.value, unit);
    row["z"] = number_or_null(prediction.z);
    row["fidelity"] = engine::fidelity_names[fidelity];
    result.push_back(std::move(row));
  }
  return result;
}

/// One offset per measurement; empty where the fidelities do not differ.
Json print_offset(const Calibration& calibration, const Fit& fit) {
  Json result = Json::array();
  for (std::size_t i = 0; i < fit.offset.size(); ++i) {
    const Unit& unit = calibration.measurements.at(i).unit;
    result.push_back({{"value", in_unit(fit.offset[i], unit)},
                      {"standard_error", in_unit(fit.offset_error.at(i), unit)},
                      {"unit", unit.symbol}});
  }
  return result;
}

Json print_history(const Calibration& calibration, const Fit& fit) {
  Json result = Json::array();
  for (const HistoryPoint& point : fit.history) {
    Json parameters = Json::array();
    for (const FreeParameter& free : calibration.free) {
      parameters.push_back(in_unit(point.parameters.get_or(free.key, engine::absent), free.unit));
    }
    result.push_back({{"evaluation", point.evaluation},
                      {"stage", point.stage},
                      {"parameters", std::move(parameters)},
                      {"observed", print_values(calibration, point.values)},
                      {"misfit", number_or_null(point.misfit)},
                      {"best", number_or_null(point.best)}});
  }
  return result;
}

// Reading back. nlohmann's at() and get() throw where a member is missing or of another type.

std::vector<calibrator::FittedParameter> read_parameters(const Calibration& calibration,
                                                         const Json& json) {
  std::vector<calibrator::FittedParameter> result;
  for (const Json& entry : json) {
    const FreeParameter& free = calibration.free.at(result.size());
    const double factor = free.unit.factor;
    result.push_back({free.key,
                      number_or_nan(entry.at("value")) * factor,
                      number_or_nan(entry.at("interval").at(0)) * factor,
                      number_or_nan(entry.at("interval").at(1)) * factor,
                      entry.at("at_bound").at("lower").get<bool>(),
                      entry.at("at_bound").at("upper").get<bool>(),
                      number_or_nan(entry.at("learnt")),
                      entry.at("determined").get<bool>()});
  }
  return result;
}

std::vector<calibrator::Prediction> read_predictions(const Calibration& calibration,
                                                     const Json& json) {
  std::vector<calibrator::Prediction> result;
  for (const Json& row : json) {
    const std::size_t index = result.size();
    const double factor = calibration.measurements.at(index).unit.factor;
    result.push_back({index,
                      number_or_nan(row.at("predicted")) * factor,
                      number_or_nan(row.at("predicted_error")) * factor,
                      row.at("replicates").get<int>(),
                      number_or_nan(row.at("scatter")) * factor,
                      number_or_nan(row.at("emulated")) * factor,
                      number_or_nan(row.at("emulated_deviation")) * factor,
                      number_or_nan(row.at("z"))});
  }
  return result;
}

/// The name as it lives in the program, since a history point does not own its stage.
std::string_view stage_named(const std::string& name) {
  static constexpr std::array<std::string_view, 5> stages{
      "start", "replicate", "pair", "search", "confirm"};
  const auto found = std::ranges::find(stages, std::string_view(name));
  if (found == stages.end()) throw std::invalid_argument("an unknown stage");
  return *found;
}

std::vector<HistoryPoint> read_history(const Calibration& calibration, const Json& json) {
  std::vector<HistoryPoint> result;
  const calibrator::SearchSpace space(calibration);
  for (const Json& entry : json) {
    HistoryPoint point;
    point.evaluation = entry.at("evaluation").get<int>();
    point.stage = stage_named(entry.at("stage").get<std::string>());
    engine::ParameterSet free;
    for (std::size_t k = 0; k < calibration.free.size(); ++k) {
      const FreeParameter& parameter = calibration.free[k];
      free.set(parameter.key, number_or_nan(entry.at("parameters").at(k)) * parameter.unit.factor);
    }
    point.parameters = space.at(space.coordinates(free));
    for (const auto& [key, value] : free) point.parameters.set(key, value);
    for (std::size_t i = 0; i < calibration.measurements.size(); ++i) {
      point.values.push_back(number_or_nan(entry.at("observed").at(i)) *
                             calibration.measurements[i].unit.factor);
    }
    point.misfit = number_or_nan(entry.at("misfit"));
    point.best = number_or_nan(entry.at("best"));
    result.push_back(std::move(point));
  }
  return result;
}

void read_offset(const Calibration& calibration, const Json& json, Fit& fit) {
  for (std::size_t i = 0; i < json.size(); ++i) {
    const double factor = calibration.measurements.at(i).unit.factor;
    fit.offset.push_back(number_or_nan(json[i].at("value")) * factor);
    fit.offset_error.push_back(number_or_nan(json[i].at("standard_error")) * factor);
  }
}

calibrator::StopReason stop_named(const std::string& name) {
  const auto found = std::ranges::find(calibrator::stop_reason_names, std::string_view(name));
  if (found == calibrator::stop_reason_names.end()) throw std::invalid_argument("unknown stop");
  return static_cast<calibrator::StopReason>(found - calibrator::stop_reason_names.begin());
}

Fit read_fit(const Calibration& calibration, const Json& json) {
  Fit fit;
  fit.best = read_parameter_set(json.at("best"));
  fit.parameters = read_parameters(calibration, json.at("parameters"));
  fit.directions = read_directions(json);
  fit.posterior = read_posterior(calibration, json);
  fit.next = read_next(calibration, json);
  fit.predictions = read_predictions(calibration, json.at("measurements"));
  read_offset(calibration, json.at("offset"), fit);
  fit.misfit = number_or_nan(json.at("misfit"));
  fit.evaluations = json.at("evaluations").get<int>();
  fit.failed = json.at("failed").get<int>();
  fit.stop = stop_named(json.at("stop").get<std::string>());
  fit.history = read_history(calibration, json.at("history"));
  fit.remarks = json.at("remarks").get<std::vector<std::string>>();
  return fit;
}

}  // namespace

std::string print_fit(const Calibration& calibration, const Fit& fit) {
  const Json document{{"stop", calibrator::stop_reason_names[static_cast<std::size_t>(fit.stop)]},
                      {"misfit", number_or_null(fit.misfit)},
                      {"evaluations", fit.evaluations},
                      {"failed", fit.failed},
                      {"parameters", print_parameters(calibration, fit)},
                      {"measurements", print_measurements(calibration, fit)},
                      {"directions", print_directions(calibration, fit.directions)},
                      {"next_measurements", print_next(calibration, fit.next)},
                      {"offset", print_offset(calibration, fit)},
                      {"remarks", fit.remarks},
                      {"best", print_parameter_set(calibration, fit.best)},
                      {"posterior", print_posterior(calibration, fit.posterior)},
                      {"history", print_history(calibration, fit)},
                      {"seed", calibration.seed},
                      {"engine_version", engine::version()}};
  return to_text(document);
}

engine::Result<Fit, std::string> parse_fit(const Calibration& calibration, std::string_view text) {
  ProblemList problems;
  const auto json = parse_text(text, own_text(text), problems);
  if (!json) return engine::Unexpected{problems.all().front().message};
  try {
    return read_fit(calibration, *json);
  } catch (const std::exception& error) {
    return engine::Unexpected{"this is no fit of that calibration: " + std::string(error.what())};
  }
}

std::string print_progress(const Calibration& calibration, const calibrator::Progress& progress) {
  return to_text(Json{{"stage", progress.stage},
                      {"evaluations_done", progress.evaluations_done},
                      {"evaluations_planned", progress.evaluations_planned},
                      {"misfit", number_or_null(progress.misfit)},
                      {"predicted", print_values(calibration, progress.predicted)},
                      {"z", Json(progress.z)},
                      {"best", print_parameter_set(calibration, progress.best)}});
}

}  // namespace repose::server
