#include "server/exports/export.hpp"

#include <cmath>
#include <sstream>

#include <catch2/catch.hpp>

#include "engine/material.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose;
using namespace repose::server;

namespace {

using engine::make_key;
using engine::MaterialId;

ExportedFit fit_of(engine::ParameterSet set) {
  ExportedFit fit;
  fit.id = 7;
  fit.finished_at = "2026-11-29T03:00:00Z";
  fit.engine_version = "1";
  fit.calibration.name = "soybean,\nwith \"quotes\"";
  fit.calibration.free.push_back(
      {.key = make_key("sliding_friction.coefficient", {MaterialId::grain, MaterialId::grain}),
       .unit = engine::unit::one});
  fit.fit.parameters.push_back(
      {fit.calibration.free[0].key, 0.45, 0.4, 0.5, false, false, 0.9, true});
  fit.fit.best = std::move(set);
  return fit;
}

engine::ParameterSet soybean() { return repose::tests::reference_grain(); }

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t times = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++times;
  return times;
}

}  // namespace

TEST_CASE("the numbers of a fit are those of the contact law", "[server]") {
  const DemModel model = dem_model(soybean());
  CHECK(model.diameter == Approx(6.496e-3));
  CHECK(model.grain.young == Approx(2.6e6));
  // Equal grains: E* = E / (2 (1 - nu^2)), G* = G / (2 (2 - nu)).
  CHECK(model.between_grains.modulus == Approx(2.6e6 / (2.0 * 0.9375)));
  CHECK(model.between_grains.shear == Approx(1.04e6 / 3.5));
  CHECK(model.time_step == Approx(7.6442e-5).epsilon(1e-4));  // 20 % of the Rayleigh time
  CHECK(model.unsaid.empty());
}

TEST_CASE("what a code cannot say is said at the top of its file", "[server]") {
  engine::ParameterSet set = soybean();
  set.set(make_key("twisting_resistance.coefficient", {MaterialId::grain, MaterialId::grain}), 0.1);
  for (const auto format : {ExportFormat::liggghts, ExportFormat::lammps, ExportFormat::yade}) {
    CHECK_THAT(print_export(fit_of(soybean()), format),
               Catch::Contains("Everything in the fit is said below"));
    const std::string text = print_export(fit_of(set), format);
    CHECK_THAT(text, Catch::Contains("NOT said below"));
    CHECK_THAT(text, Catch::Contains("#   twisting_resistance.coefficient:grain-grain = 0.1"));
  }
}

TEST_CASE("every input file is filled in, and a name cannot break out of its comment", "[server]") {
  for (const auto format : {ExportFormat::liggghts, ExportFormat::lammps, ExportFormat::yade}) {
    const std::string text = print_export(fit_of(soybean()), format);
    CHECK(count(text, "@") == 0);
    CHECK(count(text, "# --- scene") == 1);
    CHECK_THAT(text, Catch::Contains("# \"soybean, with \"quotes\"\", calibration 7"));
    CHECK_THAT(text, !Catch::Contains("nan") && !Catch::Contains("inf "));
  }
}

TEST_CASE("LIGGGHTS gets the rolling model, the cohesion and the tables of the fit", "[server]") {
  engine::ParameterSet set = soybean();
  CHECK_THAT(print_export(fit_of(set), ExportFormat::liggghts),
             Catch::Contains("rolling_friction cdt") && !Catch::Contains("cohesion"));
  const auto grains = {MaterialId::grain, MaterialId::grain};
  const auto wall = {MaterialId::grain, MaterialId::wall};
  set.erase(make_key("rolling_resistance.coefficient", grains));
  set.erase(make_key("rolling_resistance.coefficient", wall));
  CHECK_THAT(print_export(fit_of(set), ExportFormat::liggghts),
             !Catch::Contains("rolling_friction"));
  set.set(make_key("elastic_rolling_resistance.coefficient", grains), 0.07);
  set.set(make_key("area_cohesion.energy_density", grains), 2000.0);
  const std::string text = print_export(fit_of(set), ExportFormat::liggghts);
  CHECK_THAT(text, Catch::Contains("cohesion sjkr rolling_friction epsd2"));
  CHECK_THAT(text, Catch::Contains("coefficientRollingFriction peratomtypepair 2 0.07 0 0 0"));
  CHECK_THAT(print_export(fit_of(set), ExportFormat::lammps),
             Catch::Contains("area_cohesion.energy_density: LAMMPS has"));
}

TEST_CASE("LAMMPS gets the damping whose rebound is the restitution", "[server]") {
  // e = 0.6: sqrt(5) beta = 0.358873, which its polynomial reaches at 0.4811323444.
  const std::string text = print_export(fit_of(soybean()), ExportFormat::lammps);
  const auto at = text.find("pair_coeff * * hertz/material ");
  REQUIRE(at != std::string::npos);
  std::istringstream numbers(text.substr(at + 30));
  double young = 0.0, damping = 0.0;
  numbers >> young >> damping;
  CHECK(young == Approx(2.6e6));
  CHECK(damping == Approx(0.4811323444).epsilon(1e-9));
}

TEST_CASE("the rolling couple of YADE has the mean radius between grains", "[server]") {
  CHECK_THAT(print_export(fit_of(soybean()), ExportFormat::yade),
             Catch::Contains("eta=pairs(0.025, 0.05)"));
}

TEST_CASE("the table of a fit has a line for each parameter, with its interval", "[server]") {
  const engine::ParameterSet set = soybean();
  const std::string text = print_export(fit_of(set), ExportFormat::csv);
  CHECK(count(text, "\r\n") == set.size() + 1);
  CHECK_THAT(text,
             Catch::Contains("sliding_friction.coefficient,grain-grain,0.45,1,0.4,0.5,yes\r\n"));
  CHECK_THAT(text, Catch::Contains("material.diameter,grain,6.496,mm,,,fixed\r\n"));
  auto tied = fit_of(set);
  tied.calibration.tied.push_back(
      {engine::make_key("material.diameter", {engine::MaterialId::grain}),
       engine::make_key("material.density", {engine::MaterialId::grain}),
       1.0});
  CHECK_THAT(print_export(tied, ExportFormat::csv),
             Catch::Contains("material.diameter,grain,6.496,mm,,,tied\r\n"));
}
