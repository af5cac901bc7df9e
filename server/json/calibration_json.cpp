#include "server/json/calibration_json.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "calibrator/diagnosis/suspect.hpp"
#include "engine/catalogue.hpp"
#include "server/json/codec.hpp"
#include "server/json/key_json.hpp"
#include "server/json/study.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::FreeParameter;
using calibrator::Measurement;
using engine::FieldInfo;
using engine::Unit;

namespace {

void read_fidelity(const Place& place, engine::Fidelity& fidelity) {
  if (!place.exists()) return;
  const auto index = place.one_of(engine::fidelity_names, "fidelity");
  if (index) fidelity = static_cast<engine::Fidelity>(*index);
}

void read_seconds(const Place& place, std::optional<double>& seconds) {
  if (!place.exists()) return;
  const auto value = place.number();
  if (!value) return;
  if (*value > 0.0) {
    seconds = value;
  } else {
    place.complain("no evaluation takes no time", "more than 0");
  }
}

void read_budget(const Place& place, calibrator::Budget& budget) {
  Members members(place);
  const Place evaluations = members.optional("evaluations");
  const Place core_seconds = members.optional("core_seconds");
  const Place wall_seconds = members.optional("wall_seconds");
  const Place batch = members.optional("batch");
  const Place fidelity = members.optional("fidelity");
  const Place confirm_fidelity = members.optional("confirm_fidelity");
  const Place draft_runs = members.optional("draft_runs");
  const Place method = members.optional("method");
  const Place warm_start = members.optional("warm_start");
  members.no_others();
  const auto read_count = [](const Place& count, int& into, std::int64_t most) {
    if (!count.exists()) return;
    const auto value = count.whole(1, most);
    if (value) into = static_cast<int>(*value);
  };
  read_count(evaluations, budget.evaluations, 1'000'000);
  read_count(batch, budget.batch, 1'000);
  read_seconds(core_seconds, budget.core_seconds);
  read_seconds(wall_seconds, budget.wall_seconds);
  if (warm_start.exists()) budget.warm_start = warm_start.truth().value_or(false);
  read_fidelity(fidelity, budget.fidelity);
  budget.confirm_fidelity = budget.fidelity;  // what is searched is what is confirmed, unless said
  read_fidelity(confirm_fidelity, budget.confirm_fidelity);
  if (draft_runs.exists()) {
    budget.draft_runs = static_cast<int>(draft_runs.whole(0, 10'000).value_or(0));
    if (budget.draft_runs > 0 && budget.fidelity == engine::Fidelity::draft) {
      draft_runs.complain("the search itself is at draft fidelity",
                          "0, or a budget whose fidelity is standard or paper");
    }
  }
  if (!method.exists()) return;
  const auto index = method.one_of(calibrator::method_names, "method");
  if (index) budget.method = static_cast<calibrator::Method>(*index);
}

void read_suspects(const Place& place, std::vector<std::string>& suspects) {
  std::vector<std::string_view> names;
  for (const engine::EffectInfo& effect : engine::effect_catalogue()) {
    names.push_back(effect.text.name);
  }
  names.push_back(calibrator::own_wall_friction);
  for (const Place& element : place.elements()) {
    const auto index = element.one_of(names, "effect");
    if (!index) continue;
    if (std::ranges::find(suspects, names[*index]) == suspects.end()) {
      suspects.emplace_back(names[*index]);
    } else {
      element.complain("this effect is named twice", "each effect once");
    }
  }
}

void read_extends(const Place& place, std::optional<calibrator::Extension>& extends) {
  if (!place.exists()) return;
  Members members(place);
  const Place calibration = members.required("calibration", "the number of a calibration");
  const Place diagnosis = members.optional("diagnosis");
  const Place effect = members.required("effect", "the name of the effect that is added");
  members.no_others();
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  calibrator::Extension read;
  const auto id = calibration.exists() ? calibration.whole(1, most) : std::nullopt;
  if (diagnosis.exists()) read.diagnosis = diagnosis.whole(1, most);
  auto name = effect.exists() ? effect.text(200) : std::nullopt;
  if (!id || !name) return;
  read.calibration = *id;
  read.effect = *std::move(name);
  extends = std::move(read);
}

void read_name(const Place& place, std::string& name) {
  constexpr std::size_t longest = 200;
  if (!place.exists()) return;
  auto text = place.text(longest);
  if (text && text->empty()) place.complain("a name is not empty", "a few words");
  name = std::move(text).value_or("");
}

Json print_value(double value, const Unit& unit) {
  return exactly_in(value, unit).value_or(value / unit.factor);
}

/// {"grain": {"density": {"value", "unit"}, ...}, ...}
Json print_materials(const engine::ParameterSet& fixed) {
  Json result = Json::object();
  for (std::size_t i = 0; i < engine::material_names.size(); ++i) {
    Json material = Json::object();
    for (const FieldInfo& field : engine::material_catalogue()) {
      const auto key =
          engine::make_key(std::string(engine::Material::name) + "." + std::string(field.name),
                           {static_cast<engine::MaterialId>(i)});
      const auto value = fixed.get(key);
      if (value) material[std::string(field.name)] = print_field(*value, field);
    }
    if (!material.empty()) result[std::string(engine::material_names[i])] = std::move(material);
  }
  return result;
}

bool is_material_property(const engine::ParameterKey& key) {
  return key.field.starts_with(std::string(engine::Material::name) + ".");
}

Json print_fixed(const engine::ParameterSet& fixed) {
  Json result = Json::array();
  for (const auto& [key, value] : fixed) {
    if (is_material_property(key)) continue;
    const engine::ParameterInfo* info = engine::find_parameter(key.field);
    Json entry = print_key(key);
    entry.update(print_field(value, info != nullptr ? *info->field : FieldInfo{}));
    result.push_back(std::move(entry));
  }
  return result;
}

Json print_free(const std::vector<FreeParameter>& free) {
  Json result = Json::array();
  for (const FreeParameter& parameter : free) {
    Json entry = print_key(parameter.key);
    entry["lower"] = print_value(parameter.lower, parameter.unit);
    entry["upper"] = print_value(parameter.upper, parameter.unit);
    entry["unit"] = parameter.unit.symbol;
    entry["scale"] = calibrator::scale_names[static_cast<std::size_t>(parameter.scale)];
    if (parameter.prior) {
      entry["prior"] = {
          {"mean", print_value(parameter.prior->mean, parameter.unit)},
          {"standard_deviation", print_value(parameter.prior->deviation, parameter.unit)}};
    }
    result.push_back(std::move(entry));
  }
  return result;
}

Json print_tied(const std::vector<calibrator::Tie>& tied) {
  Json result = Json::array();
  for (const calibrator::Tie& tie : tied) {
    Json entry = print_key(tie.key);
    entry["to"] = print_key(tie.to);
    entry["factor"] = tie.factor;
    result.push_back(std::move(entry));
  }
  return result;
}

Json print_constraints(const std::vector<calibrator::Constraint>& constraints) {
  Json result = Json::array();
  for (const calibrator::Constraint& constraint : constraints) {
    Json terms = Json::array();
    for (const calibrator::Constraint::Term& term : constraint.terms) {
      terms.push_back(print_key(term.key));
      terms.back()["coefficient"] = term.coefficient;
    }
    result.push_back({{"terms", std::move(terms)},
                      {"bound", print_value(constraint.bound, constraint.unit)},
                      {"unit", constraint.unit.symbol}});
  }
  return result;
}

Json print_measurement(const Measurement& measurement) {
  Json entry{{"experiment", measurement.experiment.name}};
  Json settings = print_settings(measurement.experiment);
  if (!settings.empty()) entry["settings"] = std::move(settings);
  entry["observable"] = measurement.observable;
  entry["value"] = print_value(measurement.value, measurement.unit);
  entry["unit"] = measurement.unit.symbol;
  entry["standard_error"] = print_value(measurement.standard_error, measurement.unit);
  if (measurement.replicates > 0) entry["replicates"] = measurement.replicates;
  if (measurement.allowance != 0.0) {
    entry["allowance"] = print_value(measurement.allowance, measurement.unit);
  }
  entry["role"] = calibrator::role_names[static_cast<std::size_t>(measurement.role)];
  if (!measurement.source.empty()) entry["source"] = measurement.source;
  return entry;
}

/// The points of a curve as one measurement with lists along the setting that changes.
Json print_curve(std::span<const Measurement> points) {
  const Measurement& first = points.front();
  Json entry = print_measurement(first);
  const std::string along = setting_along(points);
  const engine::ExperimentInfo& info = *engine::find_experiment(first.experiment.name);
  Unit unit = std::ranges::find(info.settings, along, &FieldInfo::name)->unit;
  for (const Measurement& point : points) {
    unit = exact_unit(point.experiment.settings.at(along), unit);
  }
  Json& abscissae = entry["settings"][along] = {{"value", Json::array()}, {"unit", unit.symbol}};
  const auto list = [&](const char* name, auto member) {
    Json values = Json::array();
    for (const Measurement& point : points) values.push_back(member(point));
    entry[name] = std::move(values);
  };
  for (const Measurement& point : points) {
    abscissae["value"].push_back(print_value(point.experiment.settings.at(along), unit));
  }
  list("value", [](const Measurement& m) { return print_value(m.value, m.unit); });
  list("standard_error",
       [](const Measurement& m) { return print_value(m.standard_error, m.unit); });
  const auto any = [&](auto member) {
    return std::ranges::any_of(points, [&](const Measurement& m) { return m.*member != 0; });
  };
  if (any(&Measurement::allowance)) {
    list("allowance", [](const Measurement& m) { return print_value(m.allowance, m.unit); });
  }
  if (any(&Measurement::replicates)) {
    list("replicates", [](const Measurement& m) { return std::max(m.replicates, 1); });
  }
  return entry;
}

Json print_measurements(const std::vector<Measurement>& measurements) {
  Json result = Json::array();
  for (const std::span<const Measurement> line : lines_of(measurements)) {
    result.push_back(line.size() > 1 ? print_curve(line) : print_measurement(line.front()));
  }
  return result;
}

Json print_budget(const calibrator::Budget& budget) {
  const auto name = [](engine::Fidelity fidelity) {
    return engine::fidelity_names[static_cast<std::size_t>(fidelity)];
  };
  Json result{{"evaluations", budget.evaluations},
              {"batch", budget.batch},
              {"fidelity", name(budget.fidelity)},
              {"confirm_fidelity", name(budget.confirm_fidelity)}};
  if (budget.draft_runs > 0) result["draft_runs"] = budget.draft_runs;
  if (budget.warm_start) result["warm_start"] = true;
  if (budget.core_seconds) result["core_seconds"] = *budget.core_seconds;
  if (budget.wall_seconds) result["wall_seconds"] = *budget.wall_seconds;
  if (budget.method != calibrator::Method::repose) {
    result["method"] = calibrator::method_names[static_cast<std::size_t>(budget.method)];
  }
  return result;
}

}  // namespace

engine::Result<Calibration, Problems> parse_calibration(std::string_view text) {
  ProblemList problems;
  const auto json = parse_text(text, {}, problems);
  if (!json) return engine::Unexpected{problems.all()};
  const Place document(&*json, "", problems);
  if (!json->is_object()) {
    document.complain("a study is an object", "an object");
    return engine::Unexpected{problems.all()};
  }
  Study study;
  Calibration& calibration = study.calibration;
  Members members(document);
  read_name(members.required("name", "a few words"), calibration.name);
  read_materials(members.optional("materials"), study);
  read_fixed(members.optional("fixed"), study);
  read_free(members.optional("free"), study);
  read_tied(members.optional("tied"), study);
  read_constraints(members.optional("constraints"), study);
  read_measurements(members.optional("measurements"), study);
  read_suspects(members.optional("suspects"), calibration.suspects);
  read_budget(members.optional("budget"), calibration.budget);
  read_extends(members.optional("extends"), calibration.extends);
  const Place seed = members.optional("seed");
  if (seed.exists()) calibration.seed = seed.seed().value_or(1);
  members.no_others();
  check_study(document, study);
  if (!problems.empty()) return engine::Unexpected{problems.all()};
  for (Measurement& measurement : calibration.measurements) {
    measurement.experiment.fidelity = calibration.budget.fidelity;
  }
  return std::move(study.calibration);
}

std::string print_calibration(const Calibration& calibration) {
  Json document{{"name", calibration.name}, {"materials", print_materials(calibration.fixed)}};
  if (Json fixed = print_fixed(calibration.fixed); !fixed.empty()) document["fixed"] = fixed;
  document["free"] = print_free(calibration.free);
  if (!calibration.tied.empty()) document["tied"] = print_tied(calibration.tied);
  if (!calibration.constraints.empty()) {
    document["constraints"] = print_constraints(calibration.constraints);
  }
  document["measurements"] = print_measurements(calibration.measurements);
  if (!calibration.suspects.empty()) document["suspects"] = calibration.suspects;
  if (calibration.extends) {
    Json& extends = document["extends"] = {{"calibration", calibration.extends->calibration},
                                           {"effect", calibration.extends->effect}};
    if (calibration.extends->diagnosis) extends["diagnosis"] = *calibration.extends->diagnosis;
  }
  document["budget"] = print_budget(calibration.budget);
  document["seed"] = calibration.seed;
  return to_text(document, 2);
}

}  // namespace repose::server
