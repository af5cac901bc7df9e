#include "server/json/learnt_json.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "engine/catalogue.hpp"
#include "server/json/codec.hpp"
#include "server/json/key_json.hpp"
#include "server/report/label.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Direction;
using calibrator::NextMeasurement;
using calibrator::Posterior;

namespace {

double rounded(double value, int digits) {
  if (!std::isfinite(value)) return value;
  std::array<char, 40> text{};
  const auto end = std::to_chars(
      text.data(), text.data() + text.size(), value, std::chars_format::general, digits);
  std::from_chars(text.data(), end.ptr, value);
  return value;
}

/// One value per free parameter, in its unit.
Json print_row(const Calibration& calibration, const std::vector<double>& values) {
  Json row = Json::array();
  for (std::size_t k = 0; k < values.size(); ++k) {
    row.push_back(number_or_null(rounded(values[k] / calibration.free.at(k).unit.factor, 5)));
  }
  return row;
}

engine::Experiment read_experiment(const Json& entry) {
  engine::Experiment experiment;
  experiment.name = entry.at("experiment").get<std::string>();
  const engine::ExperimentInfo* info = engine::find_experiment(experiment.name);
  if (info == nullptr) throw std::invalid_argument("an unknown experiment");
  ProblemList problems;
  read_fields(Place(&entry.at("settings"), "", problems),
              info->settings,
              experiment.name,
              {.value = [&](const engine::FieldInfo& field, double value, const Place&) {
                experiment.settings[std::string(field.name)] = value;
              }});
  return experiment;
}

}  // namespace

Json print_directions(const Calibration& calibration, const std::vector<Direction>& directions) {
  Json result = Json::array();
  for (const Direction& direction : directions) {
    Json components = Json::array();
    for (std::size_t k = 0; k < direction.components.size(); ++k) {
      Json component = print_key(calibration.free.at(k).key);
      component["weight"] = number_or_null(direction.components[k] + 0.0);
      if (!direction.powers.empty()) component["power"] = number_or_null(direction.powers[k] + 0.0);
      components.push_back(std::move(component));
    }
    result.push_back({{"components", std::move(components)},
                      {"posterior_to_prior", number_or_null(direction.posterior_to_prior)},
                      {"learnt", direction.learnt}});
    if (!direction.powers.empty()) {
      result.back()["product_error"] = number_or_null(direction.product_error);
    }
  }
  return result;
}

std::vector<Direction> read_directions(const Json& fit) {
  std::vector<Direction> result;
  for (const Json& entry : fit.at("directions")) {
    Direction direction;
    for (const Json& component : entry.at("components")) {
      direction.components.push_back(number_or_nan(component.at("weight")));
      if (component.contains("power"))
        direction.powers.push_back(number_or_nan(component["power"]));
    }
    direction.posterior_to_prior = number_or_nan(entry.at("posterior_to_prior"));
    direction.learnt = entry.at("learnt").get<bool>();
    if (entry.contains("product_error"))
      direction.product_error = number_or_nan(entry["product_error"]);
    result.push_back(std::move(direction));
  }
  return result;
}

Json print_posterior(const Calibration& calibration, const Posterior& posterior) {
  Json samples = Json::array();
  for (const auto& sample : posterior.samples) samples.push_back(print_row(calibration, sample));
  Json quantiles = Json::array();
  for (std::size_t k = 0; k < posterior.quantiles.size(); ++k) {
    Json row = Json::array();
    for (const double value : posterior.quantiles[k]) {
      row.push_back(number_or_null(rounded(value / calibration.free.at(k).unit.factor, 5)));
    }
    quantiles.push_back(std::move(row));
  }
  return {{"quantiles", std::move(quantiles)},
          {"r_hat", number_or_null(posterior.r_hat)},
          {"effective_samples", number_or_null(posterior.effective_samples)},
          {"samples", std::move(samples)}};
}

Posterior read_posterior(const Calibration& calibration, const Json& fit) {
  Posterior posterior;
  if (!fit.contains("posterior")) return posterior;
  const Json& json = fit.at("posterior");
  for (const Json& row : json.at("samples")) {
    std::vector<double>& sample = posterior.samples.emplace_back();
    for (std::size_t k = 0; k < calibration.free.size(); ++k) {
      sample.push_back(number_or_nan(row.at(k)) * calibration.free[k].unit.factor);
    }
  }
  for (const Json& row : json.at("quantiles")) {
    const double factor = calibration.free.at(posterior.quantiles.size()).unit.factor;
    std::array<double, 3>& quantiles = posterior.quantiles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) quantiles.at(i) = number_or_nan(row.at(i)) * factor;
  }
  posterior.r_hat = number_or_nan(json.at("r_hat"));
  posterior.effective_samples = number_or_nan(json.at("effective_samples"));
  return posterior;
}

Json print_next(const Calibration& calibration, const std::vector<NextMeasurement>& next) {
  Json result = Json::array();
  for (const NextMeasurement& one : next) {
    const engine::Unit unit = observable_unit(calibration, one.experiment.name, one.observable);
    result.push_back({{"experiment", one.experiment.name},
                      {"settings", print_settings(one.experiment)},
                      {"observable", one.observable},
                      {"unit", unit.symbol},
                      {"again", one.again},
                      {"predicted", in_unit(one.predicted, unit)},
                      {"standard_error", in_unit(one.standard_error, unit)},
                      {"gain", number_or_null(one.gain)},
                      {"parameter", print_key(calibration.free.at(one.parameter).key)},
                      {"learnt", number_or_null(one.learnt)}});
  }
  return result;
}

std::vector<NextMeasurement> read_next(const Calibration& calibration, const Json& fit) {
  std::vector<NextMeasurement> result;
  if (!fit.contains("next_measurements")) return result;
  for (const Json& entry : fit.at("next_measurements")) {
    NextMeasurement one;
    one.experiment = read_experiment(entry);
    one.observable = entry.at("observable").get<std::string>();
    const double factor = observable_unit(calibration, one.experiment.name, one.observable).factor;
    one.again = entry.at("again").get<bool>();
    one.predicted = number_or_nan(entry.at("predicted")) * factor;
    one.standard_error = number_or_nan(entry.at("standard_error")) * factor;
    one.gain = number_or_nan(entry.at("gain"));
    const auto& free = calibration.free;
    const auto about = std::ranges::find_if(free, [&](const calibrator::FreeParameter& parameter) {
      return print_key(parameter.key) == entry.at("parameter");
    });
    if (about == free.end()) throw std::invalid_argument("an unknown parameter");
    one.parameter = static_cast<std::size_t>(about - free.begin());
    one.learnt = number_or_nan(entry.at("learnt"));
    result.push_back(std::move(one));
  }
  return result;
}

}  // namespace repose::server
