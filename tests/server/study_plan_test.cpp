#include "server/studies/study_plan.hpp"

#include <set>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "engine/catalogue.hpp"
#include "engine/session.hpp"
#include "server/json/published_study_json.hpp"

using namespace repose;
using namespace repose::server;
using engine::make_key;
using enum engine::MaterialId;

namespace {

const PublishedStudy& soybean() {
  const PublishedStudy* study = find_published_study("boac2010");
  REQUIRE(study != nullptr);
  return *study;
}

}  // namespace

TEST_CASE("the published study holds every run of its tables, once", "[server]") {
  const PublishedStudy& study = soybean();
  std::set<std::string> names;
  for (const StudyRun& run : study.runs) CHECK(names.insert(run.run).second);
  CHECK(names.size() == 26);  // 14 of Table 6 and 12 that Table 9 adds
  std::set<std::string> listed;
  for (const StudyTable& table : study.tables) {
    for (const StudyGroup& group : table.groups) {
      listed.insert(group.runs.begin(), group.runs.end());
    }
  }
  CHECK(listed == names);
  CHECK(names.contains(study.base));
  CHECK(names.contains(study.best));
  for (const StudyRun& run : study.computing_hours) CHECK(names.contains(run.run));
}

TEST_CASE("the printed numbers give the differences from the targets that the paper prints",
          "[server]") {
  const PublishedStudy& study = soybean();
  const auto percent = [&](const char* run, std::size_t experiment) {
    const StudyExperiment& what = study.experiments[experiment];
    const double mean = study.run(run).printed.at(what.experiment).mean;
    return 100.0 * (mean / what.target - 1.0);
  };
  CHECK(percent("1s_11111", 0) == Approx(-7.18).margin(0.005));
  CHECK(percent("1s_11111", 1) == Approx(1.61).margin(0.005));
  CHECK(percent("1s_16233", 0) == Approx(-3.74).margin(0.005));
  CHECK(percent("1s_16233", 1) == Approx(-0.36).margin(0.01));
  CHECK(percent("4s_11111", 0) == Approx(-6.69).margin(0.005));
}

TEST_CASE("a run's code names its inputs", "[server]") {
  const engine::ParameterSet best = run_parameters(soybean(), "1s_16233");
  CHECK(best.get(make_key("restitution.coefficient", {grain, wall})) == 0.6);
  CHECK(best.get(make_key("sliding_friction.coefficient", {grain, grain})) == 0.45);
  CHECK(best.get(make_key("sliding_friction.coefficient", {grain, wall})) == 0.30);
  CHECK(best.get(make_key("rolling_resistance.coefficient", {grain, wall})) == 0.05);
  CHECK(best.get(make_key("size_spread.deviation", {grain})) == 0.4);
  CHECK(*best.get(make_key("material.shear_modulus", {grain})) == Approx(1.04e6));
  CHECK(run_parameters(soybean(), "3s_11111").get(make_key("grain_shape.members", {grain})) == 3.0);
  CHECK(difference_text(soybean(), "1s_12233") ==
        "static friction 0.35 / 0.23, rolling friction 0.05, spread of sizes 0.4, shear modulus "
        "1.04 MPa");
  CHECK(difference_text(soybean(), soybean().base) == "base");
  CHECK_THROWS_AS(run_parameters(soybean(), "1s_19111"), std::invalid_argument);
  CHECK_THROWS_AS(run_parameters(soybean(), "1s_111"), std::invalid_argument);
}

TEST_CASE("every run and variant of the study is a question the engine accepts", "[server]") {
  const PublishedStudy& study = soybean();
  for (const StudySize size : {StudySize::quick, StudySize::full}) {
    for (const StudyExperiment& what : study.experiments) {
      const engine::ExperimentInfo* info = engine::find_experiment(what.experiment);
      REQUIRE(info != nullptr);
      for (const StudyRun& run : study.runs) {
        const engine::Trial trial{
            run_parameters(study, run.run), {what.experiment, fidelity_of(size), {}}, 1};
        CHECK(engine::check(*info, trial).empty());
      }
    }
    for (const StudyVariant& variant : study.variants) {
      for (const std::string& experiment : variant.experiments) {
        const engine::Trial trial{
            variant_parameters(study, variant), variant_experiment(variant, experiment, size), 1};
        INFO(variant.variant);
        CHECK(engine::check(*engine::find_experiment(experiment), trial).empty());
      }
    }
  }
}

TEST_CASE("the search for the best set keeps to the paper's levels and targets", "[server]") {
  const PublishedStudy& study = soybean();
  const calibrator::Calibration search = study_search(study, StudySize::full);
  CHECK(search.budget.confirm_fidelity == engine::Fidelity::paper);
  REQUIRE(search.measurements.size() == study.experiments.size());
  for (std::size_t i = 0; i < search.measurements.size(); ++i) {
    const calibrator::Measurement& target = search.measurements[i];
    CHECK(target.value / target.unit.factor == Approx(study.experiments[i].target));
  }
  for (const calibrator::FreeParameter& free : search.free) {
    INFO(engine::to_string(free.key));
    double lower = 1e300, upper = -1e300;
    for (const StudyRun& run : study.runs) {
      const double value = run_parameters(study, run.run).get(free.key).value();
      lower = std::min(lower, value);
      upper = std::max(upper, value);
    }
    CHECK(free.lower == Approx(lower));
    CHECK(free.upper == Approx(upper));
  }
  const calibrator::Calibration quick = study_search(study, StudySize::quick);
  CHECK(quick.budget.evaluations < search.budget.evaluations);
  CHECK(quick.budget.fidelity == engine::Fidelity::draft);
}
