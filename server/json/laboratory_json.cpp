#include "server/json/laboratory_json.hpp"

#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"
#include "server/json/text.hpp"

namespace repose::server {

namespace {

/// In the observable's unit; null where there was no reading.
Json in_unit(const std::vector<double>& values, const engine::Unit& unit) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number_or_null(value / unit.factor));
  return list;
}

Json readings_json(const Readings& readings) {
  Json document = Json::object();
  for (const engine::ExperimentInfo& info : engine::experiment_catalogue()) {
    for (const engine::ObservableInfo& observable : info.observables) {
      const std::string name = std::string(info.name) + "." + std::string(observable.name);
      const auto found = readings.find(name);
      if (found != readings.end()) document[name] = in_unit(found->second, observable.unit);
    }
  }
  return document;
}

Json units_json() {
  Json document = Json::object();
  for (const engine::ExperimentInfo& info : engine::experiment_catalogue()) {
    for (const engine::ObservableInfo& observable : info.observables) {
      document[std::string(info.name) + "." + std::string(observable.name)] =
          observable.unit.symbol;
    }
  }
  return document;
}

}  // namespace

std::string print_costs(const std::vector<ExperimentCost>& costs) {
  Json list = Json::array();
  for (const ExperimentCost& cost : costs) {
    Json entry{{"experiment", cost.experiment}};
    for (std::size_t k = 0; k < cost.seconds.size(); ++k) {
      entry[std::string(engine::fidelity_names.at(k))] = {{"processor_seconds", cost.seconds.at(k)},
                                                          {"sphere_steps", cost.grain_steps.at(k)}};
    }
    list.push_back(std::move(entry));
  }
  return to_text({{"engine_version", engine::version()}, {"experiments", std::move(list)}}, 2);
}

std::string print_fidelity_pairs(const std::vector<FidelityPairs>& pairs) {
  Json list = Json::array();
  for (const FidelityPairs& one : pairs) {
    const engine::Unit& unit = one.observable.unit;
    const DraftBias bias = one.bias();
    Json readings = Json::array();
    for (const auto& [draft, standard] : one.readings) {
      readings.push_back(in_unit({draft, standard}, unit));
    }
    list.push_back({{"experiment", one.experiment},
                    {"observable", one.observable.name},
                    {"unit", unit.symbol},
                    {"draft_less_standard", number_or_null(bias.mean / unit.factor)},
                    {"standard_deviation", number_or_null(bias.deviation / unit.factor)},
                    {"sets", bias.sets},
                    {"cost_ratio", number_or_null(one.cost)},
                    {"readings", std::move(readings)}});
  }
  return to_text({{"engine_version", engine::version()}, {"observables", std::move(list)}}, 2);
}

std::string print_trends(const Trends& trends) {
  Json parameters = Json::array();
  for (std::size_t p = 0; p < trends.parameters.size(); ++p) {
    const TrendParameter& parameter = trends.parameters[p];
    parameters.push_back({{"parameter", parameter.name},
                          {"unit", parameter.unit.symbol},
                          {"values", parameter.values},
                          {"readings", readings_json(trends.readings[p])}});
  }
  const auto fidelity = static_cast<std::size_t>(trends.fidelity);
  return to_text({{"engine_version", engine::version()},
                  {"fidelity", engine::fidelity_names.at(fidelity)},
                  {"missing", trends.missing},
                  {"units", units_json()},
                  {"reference", readings_json(trends.reference)},
                  {"parameters", std::move(parameters)}},
                 1);
}

}  // namespace repose::server
