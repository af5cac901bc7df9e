#include "server/json/diagnosis_json.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "calibrator/misfit.hpp"
#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"
#include "server/json/codec.hpp"
#include "server/json/deciding_measurement_json.hpp"
#include "server/json/key_json.hpp"
#include "server/json/parameters_json.hpp"
#include "server/json/read_key.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Diagnosis;
using calibrator::EffectFinding;
using calibrator::Excuse;
using calibrator::Measurement;
using calibrator::Refit;

namespace {

template <class Names, class Enumerator>
Json name_of(const Names& names, Enumerator value) {
  return names[static_cast<std::size_t>(value)];
}

template <class Enumerator, class Names>
Enumerator value_of(const Names& names, const Json& name) {
  const auto found = std::ranges::find(names, std::string_view(name.get_ref<const std::string&>()));
  if (found == names.end()) throw std::invalid_argument("an unknown name");
  return static_cast<Enumerator>(found - names.begin());
}

std::vector<double> read_values(const Calibration& calibration, const Json& json) {
  std::vector<double> values;
  for (const Json& value : json) {
    values.push_back(number_or_nan(value) * calibration.measurements.at(values.size()).unit.factor);
  }
  return values;
}

Json print_numbers(const std::vector<double>& values) {
  Json result = Json::array();
  for (const double value : values) result.push_back(number_or_null(value));
  return result;
}

std::vector<double> read_numbers(const Json& json) {
  std::vector<double> values;
  for (const Json& value : json) values.push_back(number_or_nan(value));
  return values;
}

Json print_measurements(const Calibration& calibration,
                        const calibrator::Tolerances& stated,
                        const Diagnosis& diagnosis) {
  Json result = Json::array();
  for (std::size_t j = 0; j < calibration.measurements.size(); ++j) {
    const Measurement& measurement = calibration.measurements[j];
    const double tolerance = calibrator::tolerance_of(measurement, stated);
    const double whole =
        std::hypot(measurement.standard_error, calibrator::model_error_of(measurement, stated));
    result.push_back({{"experiment", measurement.experiment.name},
                      {"settings", print_settings(measurement.experiment)},
                      {"observable", measurement.observable},
                      {"role", name_of(calibrator::role_names, measurement.role)},
                      {"unit", measurement.unit.symbol},
                      {"measured", in_unit(measurement.value, measurement.unit)},
                      {"standard_error", in_unit(measurement.standard_error, measurement.unit)},
                      {"tolerance", tolerance},
                      {"predicted", in_unit(diagnosis.predicted.at(j), measurement.unit)},
                      {"z", number_or_null((diagnosis.predicted[j] - measurement.value) / whole)}});
  }
  return result;
}

/// The strength in terms of the effect's parameters.
Json print_levers(const calibrator::Suspect& suspect,
                  const engine::ParameterSet& parameters,
                  double strength) {
  Json result = Json::array();
  for (const calibrator::Lever& lever : suspect.levers) {
    const engine::ParameterInfo* info = engine::find_parameter(lever.key.field);
    const engine::Unit unit = info != nullptr ? info->field->unit : engine::Unit{};
    Json entry = print_key(lever.key);
    entry["value"] = in_unit(lever.value(parameters, strength), unit);
    entry["unit"] = unit.symbol;
    result.push_back(std::move(entry));
  }
  return result;
}

Json print_effect(const Calibration& calibration,
                  const Diagnosis& diagnosis,
                  const EffectFinding& finding) {
  const auto levers = [&](double strength) {
    return print_levers(finding.suspect, diagnosis.parameters, strength);
  };
  return {{"name", finding.suspect.name},
          {"title", finding.suspect.title},
          {"status", name_of(calibrator::effect_status_names, finding.status)},
          {"score", number_or_null(finding.score)},
          {"p", number_or_null(finding.p)},
          {"strength", number_or_null(finding.strength)},
          {"strength_upper", number_or_null(finding.strength_upper)},
          {"detectable", number_or_null(finding.detectable)},
          {"absorbed", number_or_null(finding.absorbed)},
          {"probe_noise", number_or_null(finding.probe_noise)},
          {"strong", levers(1.0)},
          {"change", print_values(calibration, finding.change)},
          {"trace", print_numbers(finding.trace)},
          {"objection", finding.suspect.objection}};
}

Json print_excuse(const Excuse& excuse) {
  return {{"observable", excuse.observable},
          {"setting", excuse.setting},
          {"score", number_or_null(excuse.score)},
          {"p", number_or_null(excuse.p)},
          {"size", number_or_null(excuse.size)},
          {"deviance", number_or_null(excuse.deviance)},
          {"misfit", number_or_null(excuse.misfit)},
          {"misfit_p", number_or_null(excuse.misfit_p)}};
}

Json print_refit(const Calibration& calibration, const Diagnosis& diagnosis, const Refit& refit) {
  Json effects = Json::array();
  for (std::size_t k = 0; k < refit.effects.size(); ++k) {
    const calibrator::Suspect& suspect = diagnosis.effects[refit.effects[k]].suspect;
    Json entry{{"name", suspect.name}, {"strength", number_or_null(refit.strengths[k])}};
    entry["interval"] = nullptr;
    if (k < refit.strength_lower.size()) {
      entry["interval"] = {number_or_null(refit.strength_lower[k]),
                           number_or_null(refit.strength_upper[k])};
    }
    effects.push_back(std::move(entry));
  }
  return {{"effects", std::move(effects)},
          {"gain", number_or_null(refit.gain)},
          {"deviance", number_or_null(refit.deviance)},
          {"misfit", number_or_null(refit.misfit)},
          {"freedom", number_or_null(refit.freedom)},
          {"p", number_or_null(refit.p)},
          {"at_bound", refit.at_bound},
          {"fitted_z", number_or_null(refit.fitted_z)},
          {"held_out_z", number_or_null(refit.held_out_z)},
          {"predicted", print_values(calibration, refit.predicted)},
          {"parameters", print_parameter_set(calibration, refit.parameters)}};
}

Json print_names(const Diagnosis& diagnosis, const std::vector<std::size_t>& effects) {
  Json result = Json::array();
  for (const std::size_t effect : effects) {
    result.push_back(diagnosis.effects.at(effect).suspect.name);
  }
  return result;
}

std::size_t effect_named(const Diagnosis& diagnosis, const Json& name) {
  const auto found = std::ranges::find_if(diagnosis.effects, [&](const EffectFinding& finding) {
    return finding.suspect.name == name.get_ref<const std::string&>();
  });
  if (found == diagnosis.effects.end()) throw std::invalid_argument("an unknown effect");
  return static_cast<std::size_t>(found - diagnosis.effects.begin());
}

EffectFinding read_effect(const Calibration& calibration, const Json& json) {
  EffectFinding finding;
  finding.suspect.name = json.at("name").get<std::string>();
  finding.suspect.title = json.at("title").get<std::string>();
  finding.suspect.objection = json.at("objection").get<std::string>();
  for (const Json& entry : json.at("strong")) {
    ProblemList problems;
    Members members(Place(&entry, "", problems));
    const auto named = read_key(members);
    const auto unit = engine::unit::find(entry.at("unit").get<std::string>());
    if (!named || !unit) continue;
    const engine::ParameterInfo* info = engine::find_parameter(named->key.field);
    finding.suspect.levers.push_back({.key = named->key,
                                      .null_value = info != nullptr ? info->field->null_value : 0.0,
                                      .strong = number_or_nan(entry.at("value")) * unit->factor,
                                      .lower = info != nullptr ? info->field->lower : 0.0,
                                      .upper = info != nullptr ? info->field->upper : 1.0});
  }
  finding.status =
      value_of<calibrator::EffectStatus>(calibrator::effect_status_names, json.at("status"));
  finding.score = number_or_nan(json.at("score"));
  finding.p = number_or_nan(json.at("p"));
  finding.strength = number_or_nan(json.at("strength"));
  finding.strength_upper = number_or_nan(json.at("strength_upper"));
  finding.detectable = number_or_nan(json.at("detectable"));
  finding.absorbed = number_or_nan(json.at("absorbed"));
  finding.probe_noise = number_or_nan(json.at("probe_noise"));
  finding.change = read_values(calibration, json.at("change"));
  finding.trace = read_numbers(json.at("trace"));
  return finding;
}

Excuse read_excuse(const Json& json) {
  return {json.at("observable").get<std::string>(),
          json.at("setting").get<std::string>(),
          number_or_nan(json.at("score")),
          number_or_nan(json.at("p")),
          number_or_nan(json.at("size")),
          number_or_nan(json.at("deviance")),
          number_or_nan(json.at("misfit")),
          number_or_nan(json.at("misfit_p"))};
}

Refit read_refit(const Calibration& calibration, const Diagnosis& diagnosis, const Json& json) {
  Refit refit;
  for (const Json& entry : json.at("effects")) {
    refit.effects.push_back(effect_named(diagnosis, entry.at("name")));
    refit.strengths.push_back(number_or_nan(entry.at("strength")));
    const Json& interval = entry.at("interval");
    if (!interval.is_array()) continue;
    refit.strength_lower.push_back(number_or_nan(interval.at(0)));
    refit.strength_upper.push_back(number_or_nan(interval.at(1)));
  }
  refit.gain = number_or_nan(json.at("gain"));
  refit.deviance = number_or_nan(json.at("deviance"));
  refit.misfit = number_or_nan(json.at("misfit"));
  refit.freedom = number_or_nan(json.at("freedom"));
  refit.p = number_or_nan(json.at("p"));
  refit.at_bound = json.at("at_bound").get<bool>();
  refit.fitted_z = number_or_nan(json.at("fitted_z"));
  refit.held_out_z = number_or_nan(json.at("held_out_z"));
  refit.predicted = read_values(calibration, json.at("predicted"));
  refit.parameters = read_parameter_set(json.at("parameters"));
  return refit;
}

Diagnosis read_diagnosis(const Calibration& calibration, const Json& json) {
  Diagnosis diagnosis;
  diagnosis.verdict = value_of<calibrator::DiagnosisVerdict>(calibrator::diagnosis_verdict_names,
                                                             json.at("verdict"));
  diagnosis.grade = value_of<calibrator::Grade>(calibrator::grade_names, json.at("grade"));
  diagnosis.sentence = json.at("text").get<std::string>();
  diagnosis.p_named = number_or_nan(json.at("p").at("named"));
  diagnosis.p_unnamed = number_or_nan(json.at("p").at("unnamed"));
  diagnosis.p_misfit = number_or_nan(json.at("p").at("misfit"));
  diagnosis.p_held_out = json.at("p").value("held_out", 1.0);  // older ones have none
  diagnosis.misfit = number_or_nan(json.at("misfit"));
  diagnosis.freedom = number_or_nan(json.at("freedom"));
  diagnosis.fitted_z = number_or_nan(json.at("fitted_z"));
  diagnosis.held_out_z = number_or_nan(json.at("held_out_z"));
  diagnosis.parameters = read_parameter_set(json.at("parameters"));
  for (std::size_t j = 0; j < calibration.measurements.size(); ++j) {
    diagnosis.predicted.push_back(number_or_nan(json.at("measurements").at(j).at("predicted")) *
                                  calibration.measurements[j].unit.factor);
  }
  for (const Json& entry : json.at("effects")) {
    diagnosis.effects.push_back(read_effect(calibration, entry));
  }
  for (const Json& entry : json.at("excuses")) diagnosis.excuses.push_back(read_excuse(entry));
  for (const Json& entry : json.at("refits")) {
    diagnosis.refits.push_back(read_refit(calibration, diagnosis, entry));
  }
  diagnosis.plausible = json.at("plausible").get<std::vector<std::size_t>>();
  for (const Json& family : json.at("families")) {
    diagnosis.families.emplace_back();
    for (const Json& name : family) {
      diagnosis.families.back().push_back(effect_named(diagnosis, name));
    }
  }
  if (json.contains("next")) read_next(json.at("next"), diagnosis);  // older ones have none
  diagnosis.evaluations = json.at("evaluations").get<int>();
  diagnosis.remarks = json.at("remarks").get<std::vector<std::string>>();
  return diagnosis;
}

}  // namespace

std::string print_diagnosis(const Calibration& calibration,
                            const calibrator::Tolerances& stated,
                            const Diagnosis& diagnosis) {
  Json document{{"verdict", name_of(calibrator::diagnosis_verdict_names, diagnosis.verdict)},
                {"grade", name_of(calibrator::grade_names, diagnosis.grade)},
                {"text", diagnosis.sentence},
                {"p",
                 {{"named", diagnosis.p_named},
                  {"unnamed", diagnosis.p_unnamed},
                  {"misfit", diagnosis.p_misfit},
                  {"held_out", diagnosis.p_held_out}}},
                {"misfit", number_or_null(diagnosis.misfit)},
                {"freedom", number_or_null(diagnosis.freedom)},
                {"fitted_z", number_or_null(diagnosis.fitted_z)},
                {"held_out_z", number_or_null(diagnosis.held_out_z)},
                {"measurements", print_measurements(calibration, stated, diagnosis)},
                {"parameters", print_parameter_set(calibration, diagnosis.parameters)}};
  Json& effects = document["effects"] = Json::array();
  for (const EffectFinding& finding : diagnosis.effects) {
    effects.push_back(print_effect(calibration, diagnosis, finding));
  }
  Json& excuses = document["excuses"] = Json::array();
  for (const Excuse& excuse : diagnosis.excuses) excuses.push_back(print_excuse(excuse));
  Json& refits = document["refits"] = Json::array();
  for (const Refit& refit : diagnosis.refits) {
    refits.push_back(print_refit(calibration, diagnosis, refit));
  }
  document["plausible"] = diagnosis.plausible;
  Json& families = document["families"] = Json::array();
  for (const auto& family : diagnosis.families) families.push_back(print_names(diagnosis, family));
  Json& next = document["next"] = Json::array();
  for (const auto& measurement : diagnosis.next) next.push_back(print_next(diagnosis, measurement));
  document["evaluations"] = diagnosis.evaluations;
  document["remarks"] = diagnosis.remarks;
  document["seed"] = calibration.seed;
  document["engine_version"] = engine::version();
  return to_text(document);
}

engine::Result<Diagnosis, std::string> parse_diagnosis(const Calibration& calibration,
                                                       std::string_view text) {
  ProblemList problems;
  const auto json = parse_text(text, own_text(text), problems);
  if (!json) return engine::Unexpected{problems.all().front().message};
  try {
    return read_diagnosis(calibration, *json);
  } catch (const std::exception& error) {
    return engine::Unexpected{"this is no diagnosis of that calibration: " +
                              std::string(error.what())};
  }
}

}  // namespace repose::server
