#include "server/json/deciding_measurement_json.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "server/json/codec.hpp"
#include "server/json/key_json.hpp"

namespace repose::server {
namespace {

using calibrator::DecidingMeasurement;
using calibrator::Diagnosis;

std::vector<std::size_t> read_model(const Json& names, const Diagnosis& diagnosis) {
  std::vector<std::size_t> effects;
  for (const Json& name : names) {
    const auto found = std::ranges::find_if(diagnosis.effects, [&](const auto& finding) {
      return finding.suspect.name == name.get_ref<const std::string&>();
    });
    if (found == diagnosis.effects.end()) throw std::invalid_argument("an unknown effect");
    effects.push_back(static_cast<std::size_t>(found - diagnosis.effects.begin()));
  }
  return effects;
}

}  // namespace

Json print_next(const Diagnosis& diagnosis, const DecidingMeasurement& next) {
  Json expected = Json::array();
  for (std::size_t i = 0; i < next.predicted.size(); ++i) {
    Json model = Json::array();
    for (const std::size_t effect : diagnosis.rivals.at(i)) {
      model.push_back(diagnosis.effects.at(effect).suspect.name);
    }
    expected.push_back(
        {{"model", std::move(model)}, {"value", in_unit(next.predicted[i], next.unit)}});
  }
  return {{"experiment", next.experiment.name},
          {"settings", print_settings(next.experiment)},
          {"observable", next.observable},
          {"unit", next.unit.symbol},
          {"standard_error", in_unit(next.standard_error, next.unit)},
          {"expected", std::move(expected)},
          {"evidence", number_or_null(next.evidence)},
          {"gain", number_or_null(next.gain)}};
}

void read_next(const Json& json, Diagnosis& diagnosis) {
  for (const Json& entry : json) {
    DecidingMeasurement next;
    next.experiment.name = entry.at("experiment").get<std::string>();
    for (const auto& [name, setting] : entry.at("settings").items()) {
      const auto unit = engine::unit::find(setting.at("unit").get<std::string>());
      next.experiment.settings[name] =
          setting.at("value").get<double>() * (unit ? unit->factor : 1.0);
    }
    next.observable = entry.at("observable").get<std::string>();
    next.unit = engine::unit::find(entry.at("unit").get<std::string>()).value_or(engine::Unit{});
    next.standard_error = entry.at("standard_error").get<double>() * next.unit.factor;
    next.evidence = entry.at("evidence").get<double>();
    next.gain = entry.at("gain").get<double>();
    const bool first = diagnosis.next.empty();
    for (const Json& expected : entry.at("expected")) {
      next.predicted.push_back(expected.at("value").get<double>() * next.unit.factor);
      if (first) diagnosis.rivals.push_back(read_model(expected.at("model"), diagnosis));
    }
    diagnosis.next.push_back(std::move(next));
  }
}

}  // namespace repose::server
