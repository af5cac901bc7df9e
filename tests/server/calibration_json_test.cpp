#include "server/json/calibration_json.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <utility>

#include <catch2/catch.hpp>

#include "calibrator/search_space.hpp"
#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"
#include "server/json/codec.hpp"
#include "server/json/text.hpp"

namespace {

using repose::calibrator::Calibration;
using repose::server::Json;
using repose::server::parse_calibration;
using repose::server::print_calibration;
using repose::server::Problems;
using repose::server::to_text;
namespace calibrator = repose::calibrator;
namespace engine = repose::engine;

/// A small study without a problem.
Json study() {
  return Json::parse(R"({
    "name": "small",
    "materials": {
      "grain": {"density": {"value": 1228, "unit": "kg/m3"}, "diameter": {"value": 6.5, "unit": "mm"},
                "shear_modulus": {"value": 1.04, "unit": "MPa"}, "poisson_ratio": {"value": 0.25, "unit": "1"}},
      "wall": {"shear_modulus": {"value": 80, "unit": "GPa"}, "poisson_ratio": {"value": 0.3, "unit": "1"}}},
    "free": [{"field": "restitution.coefficient", "between": ["grain", "wall"], "lower": 0.3, "upper": 0.9, "unit": "1"}],
    "measurements": [{"experiment": "drop", "observable": "restitution", "value": 0.6, "unit": "1", "standard_error": 0.02}]
  })");
}

Calibration read(const Json& json) {
  auto result = parse_calibration(to_text(json));
  if (!result) FAIL(result.error().at(0).pointer << " " << result.error().at(0).message);
  return std::move(result).value();
}

std::vector<std::string> pointers(const Json& json) {
  const auto result = parse_calibration(to_text(json));
  std::vector<std::string> found;
  if (result) return found;
  for (const auto& problem : result.error()) found.push_back(problem.pointer);
  return found;
}

using Strings = std::vector<std::string>;

/// A number as a person writes it, in one of the units of that dimension, in SI.
class Author {
 public:
  explicit Author(std::uint64_t seed) : random_(seed) {}

  engine::Unit unit_like(const engine::Unit& like) {
    const auto symbols = repose::server::units_like(like);
    return *engine::unit::find(symbols[below(symbols.size())]);
  }
  double within(double lower, double upper) {
    return std::uniform_real_distribution(lower, upper)(random_);
  }
  double within(const engine::FieldInfo& field, const engine::Unit& unit) {
    return within(field.lower / unit.factor, field.upper / unit.factor) * unit.factor;
  }
  std::size_t below(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
  }
  bool chance() { return below(2) == 0; }

 private:
  std::mt19937_64 random_;
};

/// Whether values anywhere within the bounds go with those of other effects: grains have one shape
/// and one distribution of sizes, and moisture takes what it changes out of its bounds.
bool goes_with_others(const std::string& name) {
  const std::string effect = name.substr(0, name.find('.'));
  return effect != "grain_shape" && effect != "sphere_clump" && !effect.ends_with("_sizes") &&
         !effect.starts_with("moisture_");
}

/// Settings that the experiment would work with, for grains of those parameters.
std::map<std::string, double> any_settings(Author& author,
                                           const engine::ExperimentInfo& info,
                                           const engine::ParameterSet& parameters) {
  std::map<std::string, double> settings;
  for (const engine::FieldInfo& field : info.settings) {
    if (author.chance()) continue;
    const double value = field.choices.empty()
                             ? author.within(field, author.unit_like(field.unit))
                             : static_cast<double>(author.below(field.choices.size()));
    auto with = settings;
    with[std::string(field.name)] = value;
    const engine::Experiment experiment{std::string(info.name), engine::Fidelity::draft, with};
    if (engine::refusal({parameters, experiment, 1}).empty()) settings = std::move(with);
  }
  return settings;
}

/// Of the experiment with that number, so that no two contradict each other.
calibrator::Measurement any_measurement(Author& author,
                                        std::size_t experiment,
                                        const engine::ParameterSet& parameters) {
  const auto experiments = engine::experiment_catalogue();
  const engine::ExperimentInfo& info = experiments[experiment % experiments.size()];
  const engine::ObservableInfo& seen = info.observables[author.below(info.observables.size())];
  calibrator::Measurement measurement;
  measurement.experiment.name = info.name;
  measurement.experiment.settings = any_settings(author, info, parameters);
  measurement.observable = seen.name;
  measurement.unit = author.unit_like(seen.unit);
  measurement.value = author.within(0.1, 100.0) * measurement.unit.factor;
  measurement.standard_error = author.within(0.1, 1.0) * measurement.unit.factor;
  if (author.chance()) measurement.allowance = author.within(0.0, 1.0) * measurement.unit.factor;
  if (author.chance()) measurement.source = "a \"source\", \xC3\xA9\n";
  return measurement;
}

Calibration any_calibration(std::uint64_t seed) {
  Author author(seed);
  Calibration result;
  result.name = "any";
  const std::vector<engine::MaterialId> pair{engine::MaterialId::grain, engine::MaterialId::wall};
  for (const std::string& name : engine::parameter_names()) {
    const engine::ParameterInfo& info = *engine::find_parameter(name);
    if (!goes_with_others(name)) continue;
    engine::FieldInfo field = *info.field;
    if (name == "material.diameter") field.upper = 0.002;  // m; the apparatus has room for it
    for (const engine::MaterialId material : pair) {
      if (info.scope == engine::Scope::global && material == pair.back()) continue;  // is one
      std::vector<engine::MaterialId> between;
      if (info.scope != engine::Scope::global) between.push_back(material);
      if (info.scope == engine::Scope::pair) between.push_back(engine::MaterialId::grain);
      const auto key = engine::make_key(name, between);
      const engine::Unit unit = author.unit_like(field.unit);
      if (author.chance()) {
        result.fixed.set(key, author.within(field, unit));
        continue;
      }
      double lower = author.within(field, unit);
      double upper = author.within(field, unit);
      if (lower > upper) std::swap(lower, upper);
      const bool log = author.chance() && lower > 0.0;
      const auto scale = log ? calibrator::Scale::log : calibrator::Scale::linear;
      result.free.push_back({key, lower, upper, scale, unit});
    }
  }
  if (!result.free.empty()) {
    calibrator::FreeParameter& first = result.free.front();
    if (author.chance()) first.prior = calibrator::Prior{first.lower, 0.3 * first.unit.factor};
    result.constraints.push_back({{{first.key, 1.0}}, first.upper, first.unit});
  }
  const calibrator::SearchSpace space(result);
  const auto middle = space.at(calibrator::UnitPoint(space.dimensions(), 0.5));
  for (std::size_t i = 0; i < 4; ++i) {
    result.measurements.push_back(any_measurement(author, seed + i, middle));
  }
  calibrator::Measurement point = any_measurement(author, seed + 4, middle);
  point.observable = "dynamic_angle";
  point.experiment = {"drum", {}, {{"speed", 1.0}}};
  point.unit = engine::unit::degree;
  point.value = author.within(0.1, 100.0) * point.unit.factor;
  point.standard_error = author.within(0.1, 1.0) * point.unit.factor;
  point.allowance = author.within(0.0, 1.0) * point.unit.factor;
  point.curve = 1;
  std::erase_if(result.measurements,
                [](const calibrator::Measurement& m) { return m.experiment.name == "drum"; });
  result.measurements.push_back(point);
  point.experiment.settings["speed"] = 2.5;
  point.value = author.within(0.1, 100.0) * point.unit.factor;
  result.measurements.push_back(point);
  if (author.chance()) result.measurements[1].role = calibrator::Role::held_out;
  if (author.chance()) result.suspects = {std::string(engine::effect_catalogue()[0].text.name)};
  result.budget = {.evaluations = 1000, .batch = 3, .fidelity = engine::Fidelity::draft};
  for (auto& each : result.measurements) each.experiment.fidelity = result.budget.fidelity;
  result.seed = seed;
  return result;
}

}  // namespace

TEST_CASE("any calibration that is printed is read back as it was", "[server]") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Calibration calibration = any_calibration(seed);
    const std::string text = print_calibration(calibration);
    const auto again = parse_calibration(text);
    INFO(text);
    REQUIRE(again);
    CHECK(*again == calibration);
    CHECK(print_calibration(*again) == text);
  }
}

TEST_CASE("the order of members and of a pair's materials does not matter", "[server]") {
  Json turned = study();
  turned["free"][0]["between"] = {"wall", "grain"};
  Json shuffled = Json::object();
  for (const char* name : {"measurements", "free", "materials", "name"}) {
    shuffled[name] = turned[name];
  }
  CHECK(print_calibration(read(shuffled)) == print_calibration(read(study())));
}

TEST_CASE("numbers are printed in the author's units with the author's digits", "[server]") {
  Json json = study();
  json["measurements"][0]["value"] = 60.3;
  json["measurements"][0]["standard_error"] = 2.1;
  json["measurements"][0]["unit"] = "%";
  const Json printed = Json::parse(print_calibration(read(json)));
  CHECK(printed["measurements"][0]["unit"] == "%");
  CHECK(to_text(printed["measurements"][0]["value"]) == "60.3");
  CHECK(to_text(printed["measurements"][0]["standard_error"]) == "2.1");
  CHECK(to_text(printed["materials"]["grain"]["diameter"]) == R"({"value":6.5,"unit":"mm"})");
}

TEST_CASE("a standard deviation becomes the standard error of the mean", "[server]") {
  Json json = study();
  json["measurements"][0].erase("standard_error");
  json["measurements"][0]["standard_deviation"] = 0.06;
  json["measurements"][0]["replicates"] = 9;
  CHECK(read(json).measurements[0].standard_error == Approx(0.02));
}

TEST_CASE("an allowance of what right codes differ by is in the measurement's unit", "[server]") {
  Json box = study();
  box["measurements"][0] = {{"experiment", "tilting_box"},
                            {"observable", "static_angle"},
                            {"value", 30},
                            {"unit", "deg"},
                            {"standard_error", 0.5},
                            {"allowance", "tolerance"}};
  const auto& angle = read(box).measurements.front();
  // A tenth of the tangent: half of sin(60 deg) rad for 100 %.
  CHECK(angle.allowance == Approx(0.1 * 0.5 * std::sqrt(3.0) / 2.0));
  Json number = box;
  number["measurements"][0]["allowance"] = angle.allowance * 180.0 / M_PI;
  CHECK(read(number).measurements.front().allowance == Approx(angle.allowance));
}

TEST_CASE("a measurement without an uncertainty is refused with the sentence that mends it",
          "[server]") {
  Json json = study();
  json["measurements"][0].erase("standard_error");
  const auto result = parse_calibration(to_text(json));
  REQUIRE(!result);
  REQUIRE(result.error().size() == 1);
  CHECK(result.error()[0].message.find("Add \"standard_error\"") != std::string::npos);
}

TEST_CASE("what is confirmed is what was searched unless the study says otherwise", "[server]") {
  Json json = study();
  json["budget"] = {{"fidelity", "draft"}};
  CHECK(read(json).budget.confirm_fidelity == engine::Fidelity::draft);
  CHECK(read(json).measurements[0].experiment.fidelity == engine::Fidelity::draft);
  json["budget"]["confirm_fidelity"] = "paper";
  CHECK(read(json).budget.confirm_fidelity == engine::Fidelity::paper);
}

TEST_CASE("a property that is described and free is free", "[server]") {
  Json json = study();
  json["free"].push_back({{"field", "material.shear_modulus"},
                          {"between", {"grain"}},
                          {"lower", 1},
                          {"upper", 10},
                          {"unit", "MPa"}});
  const Calibration calibration = read(json);
  const auto key = engine::make_key("material.shear_modulus", {engine::MaterialId::grain});
  CHECK(!calibration.fixed.get(key));
  CHECK(calibration.free.size() == 2);
}

TEST_CASE("a property may be tied instead of given", "[server]") {
  Json json = study();
  json["materials"]["wall"].erase("shear_modulus");
  CHECK(pointers(json) == Strings{"/materials/wall/shear_modulus"});
  json["tied"] = Json::parse(R"([{"field": "material.shear_modulus", "between": ["wall"],
      "to": {"field": "material.shear_modulus", "between": ["grain"]}, "factor": 2}])");
  CHECK(read(json).tied[0].factor == 2.0);
}

TEST_CASE("a grain's spheres become parameters of the clump", "[server]") {
  Json shaped = study();
  shaped["materials"]["grain"]["shape"] = Json::parse(
      R"({"unit": "mm", "spheres": [{"x": 0, "y": 0, "z": 0, "radius": 2.85},
                                    {"x": 0, "y": 0, "z": 1.89, "radius": 2.85}]})");
  const auto get = [fixed = read(shaped).fixed](const char* field) {
    return fixed.get({field, {engine::MaterialId::grain}});
  };
  CHECK(get("sphere_clump.radius_1") == Approx(2.85e-3));
  CHECK(get("sphere_clump.z_2") == Approx(1.89e-3));
  CHECK_FALSE(get("sphere_clump.radius_3").has_value());
  const Calibration again = read(Json::parse(print_calibration(read(shaped))));
  CHECK(again.fixed == read(shaped).fixed);
}

TEST_CASE("a grain whose spheres make no clump is refused at its shape", "[server]") {
  const auto with = [](const char* spheres, const char* material = "grain") {
    Json shaped = study();
    shaped["materials"][material]["shape"] = {{"unit", "mm"}, {"spheres", Json::parse(spheres)}};
    return pointers(shaped);
  };
  CHECK(with(R"([{"x": 0, "y": 0, "z": 0, "radius": 1}, {"x": 0, "y": 0, "z": 3, "radius": 1}])") ==
        Strings{"/materials/grain/shape"});
  CHECK(with("[]") == Strings{"/materials/grain/shape/spheres"});
  CHECK(with(R"([{"x": 0, "y": 0, "z": 0}])") ==
        Strings{"/materials/grain/shape/spheres/0/radius"});
  CHECK(with(R"([{"x": 0, "y": 0, "z": 0, "radius": -1}])") ==
        Strings{"/materials/grain/shape/spheres/0/radius"});
  CHECK(with(R"([{"x": 0, "y": 0, "z": 0, "radius": 1}])", "wall") ==
        Strings{"/materials/wall/shape"});
}

TEST_CASE("problems of different parts are reported together", "[server]") {
  Json json = study();
  json["name"] = "";
  json["free"][0]["upper"] = 2;
  json["measurements"][0]["unit"] = "mm";
  json["sead"] = 1;
  CHECK(pointers(json) == Strings{"/name", "/free/0/upper", "/measurements/0/unit", "/sead"});
}

TEST_CASE("one mistake is not reported as a second one", "[server]") {
  Json json = study();
  json["free"][0]["unit"] = "deg";
  json["materials"]["grain"]["density"]["unit"] = "m";
  CHECK(pointers(json) == Strings{"/materials/grain/density/unit", "/free/0/unit"});
}

TEST_CASE("every member of a study may be of the wrong type without harm", "[server]") {
  const Json valid = study();
  for (const char* wrong : {"null", "7", "\"x\"", "[]", "{}", "[[]]", "[null]", "{\"a\":{}}"}) {
    for (const char* pointer : {"/name",
                                "/materials",
                                "/materials/grain",
                                "/materials/grain/density/value",
                                "/fixed",
                                "/fixed/0",
                                "/free",
                                "/free/0",
                                "/free/0/field",
                                "/free/0/between",
                                "/free/0/unit",
                                "/tied",
                                "/tied/0",
                                "/tied/0/to",
                                "/measurements",
                                "/measurements/0",
                                "/measurements/0/settings",
                                "/measurements/0/value",
                                "/suspects",
                                "/budget",
                                "/seed"}) {
      Json json = valid;
      json["fixed"] = Json::array();
      json["tied"] = Json::parse(R"([{"field": "sliding_friction.coefficient",
          "between": ["grain", "grain"], "to": {"field": "restitution.coefficient"}}])");
      json[Json::json_pointer(pointer)] = Json::parse(wrong);
      const auto result = parse_calibration(to_text(json));
      if (result) CHECK(parse_calibration(print_calibration(*result)));
    }
  }
}

TEST_CASE("a hostile study is refused", "[server]") {
  std::string nested(1'000'000, '[');
  CHECK(!parse_calibration(nested));
  std::string wide = "{";
  for (int i = 0; i < 90'000; ++i) wide += "\"" + std::to_string(i) + "\":1,";
  const auto result = parse_calibration(wide + "\"name\":\"x\"}");
  REQUIRE(!result);
  CHECK(result.error().size() == 101);
}
