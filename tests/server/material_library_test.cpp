#include "server/json/material_library.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "engine/catalogue.hpp"
#include "engine/session.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/starting_study.hpp"

using namespace repose::server;
using repose::engine::find_parameter;
using repose::engine::make_key;
using enum repose::engine::MaterialId;

namespace {

const PublishedProperty& property(std::string_view material, std::string_view name) {
  const PublishedMaterial* found = find_material(material);
  REQUIRE(found != nullptr);
  const auto at = std::ranges::find(found->properties, name, &PublishedProperty::name);
  REQUIRE(at != found->properties.end());
  return *at;
}

}  // namespace

TEST_CASE("the library holds the nine grains of its source, each with its sources", "[server]") {
  const MaterialLibrary& library = material_library();
  std::set<std::string> names;
  for (const PublishedMaterial& material : library.materials) {
    names.insert(material.name);
    CHECK(material.properties.size() >= 12);
    for (const PublishedProperty& p : material.properties) {
      for (const PublishedValue& value : p.values) CHECK(!value.sources.empty());
    }
  }
  CHECK(
      names ==
      std::set<std::string>{
          "soybean", "corn", "wheat", "sorghum", "rice", "barley", "oats", "sunflower", "canola"});
}

TEST_CASE("the bounds of a property are those of its values", "[server]") {
  for (const PublishedMaterial& material : material_library().materials) {
    for (const PublishedProperty& p : material.properties) {
      INFO(material.name << " " << p.name());
      constexpr double endless = std::numeric_limits<double>::infinity();
      double lower = endless, upper = -endless;
      for (const PublishedValue& value : p.values) {
        CHECK(value.lower <= value.upper);
        lower = std::min(lower, value.lower);
        upper = std::max(upper, value.upper);
      }
      CHECK(p.lower == lower);
      CHECK(p.upper == upper);
      CHECK(p.middle() >= lower);
      CHECK(p.middle() <= upper);
    }
  }
}

TEST_CASE("a property with materials is a parameter of the engine within its bounds", "[server]") {
  const auto check = [](const PublishedProperty& p) {
    if (!p.key) return;
    INFO(p.name());
    const auto* info = find_parameter(p.key->field);
    REQUIRE(info != nullptr);
    CHECK(p.key->between.size() == repose::engine::materials_of(info->scope));
    const auto unit = repose::engine::unit::find(p.unit);
    REQUIRE(unit);
    CHECK(unit->dimension == info->field->unit.dimension);
    CHECK(p.lower * unit->factor >= info->field->lower);
    CHECK(p.upper * unit->factor <= info->field->upper);
  };
  for (const PublishedMaterial& material : material_library().materials) {
    std::ranges::for_each(material.properties, check);
  }
  std::ranges::for_each(material_library().stand_ins, check);
}

// Of one grain in its own numbers, so that a slip of the file shows: mass = density x volume, and
// G = E / (2 + 2 nu), within the published ranges.
TEST_CASE("the published numbers of soybean agree with each other", "[server]") {
  const double mass = property("soybean", "material.density:grain").middle() *
                      property("soybean", "grain_volume").middle() * 1e-3;  // mg
  CHECK(mass == Approx(176.2).epsilon(0.001));
  CHECK(mass < property("soybean", "grain_mass").upper);
  const double shear = property("soybean", "elastic_modulus").upper /
                       (2.0 + 2.0 * 0.4);  // MPa; Misra and Young: E 176.9, nu 0.4
  CHECK(shear == Approx(property("soybean", "material.shear_modulus:grain").upper).epsilon(0.001));
}

TEST_CASE("corn's friction on steel is what the source prints", "[server]") {
  const PublishedMaterial& corn = *find_material("corn");
  const auto at = std::ranges::find_if(corn.properties, [](const PublishedProperty& p) {
    return p.surface == "steel" && p.property == "sliding_friction.coefficient";
  });
  REQUIRE(at != corn.properties.end());
  CHECK(at->lower == 0.235);
  CHECK(at->upper == 0.76);
}

TEST_CASE("a material that is not there is answered with those that are", "[server]") {
  CHECK(find_material("soy") == nullptr);
  CHECK_THAT(no_such_material("soybeen"), Catch::Contains("did you mean \"soybean\""));
  CHECK_THAT(no_such_material("x"), Catch::Contains("soybean, corn, wheat"));
}

TEST_CASE("every grain gives a study that is read and whose middle can be run", "[server]") {
  for (const PublishedMaterial& material : material_library().materials) {
    INFO(material.name);
    const StartingStudy study = starting_study(material);
    CHECK(!study.notes.empty());
    const auto calibration = parse_calibration(study.text);
    REQUIRE(calibration);
    repose::engine::Trial trial;
    trial.parameters = calibration->fixed;
    for (const auto& free : calibration->free) {
      trial.parameters.set(free.key, 0.5 * (free.lower + free.upper));
    }
    const auto* kettle = repose::engine::find_experiment("kettle");
    CHECK(repose::engine::check(*kettle, trial).empty());
    CHECK(calibration->measurements.size() == 2);
  }
}

TEST_CASE("the free parameters of a starting study have the published ranges", "[server]") {
  const auto calibration = parse_calibration(starting_study(*find_material("soybean")).text);
  REQUIRE(calibration);
  const auto free = std::ranges::find(calibration->free,
                                      make_key("sliding_friction.coefficient", {grain, grain}),
                                      &repose::calibrator::FreeParameter::key);
  REQUIRE(free != calibration->free.end());
  CHECK(free->lower == 0.267);
  CHECK(free->upper == 0.55);
  CHECK(calibration->fixed.get(make_key("material.diameter", {grain})).value() ==
        Approx(6.496e-3).epsilon(1e-3));
}
