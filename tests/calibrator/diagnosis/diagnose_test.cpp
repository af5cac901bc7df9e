#include "calibrator/diagnosis/diagnose.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/support/stand_in.hpp"

using namespace repose;
using calibrator::Diagnosis;
using calibrator::DiagnosisVerdict;

namespace {

std::string named(const Diagnosis& diagnosis) {
  return diagnosis.refits.empty()
             ? ""
             : diagnosis.effects[diagnosis.refits.front().effects.front()].suspect.name;
}

}  // namespace

TEST_CASE("a strong hidden effect is named, and adding it removes the error", "[calibrator]") {
  const auto problem = stand_in::make_problem(7, {{"hysteresis", 0.8}});
  const Diagnosis diagnosis = stand_in::diagnose(problem);
  CHECK(diagnosis.verdict == DiagnosisVerdict::named);
  REQUIRE(named(diagnosis) == "hysteresis");
  const calibrator::Refit& refit = diagnosis.refits.front();
  CHECK(refit.strengths.front() == Approx(0.8).margin(0.25));
  CHECK(refit.strength_lower.front() < 0.8);
  CHECK(refit.strength_upper.front() > 0.8);
  CHECK(refit.fitted_z < 0.6 * diagnosis.fitted_z);
  CHECK(diagnosis.evaluations <= 200);
}

TEST_CASE("where nothing is missing nothing is named, and no refit is paid for", "[calibrator]") {
  const auto problem = stand_in::make_problem(3, {});
  const Diagnosis diagnosis = stand_in::diagnose(problem);
  CHECK(diagnosis.verdict == DiagnosisVerdict::adequate);
  CHECK(diagnosis.refits.empty());
  CHECK(diagnosis.evaluations < 70);
}

TEST_CASE("what only held-out measurements show is no adequate model", "[calibrator]") {
  const auto diagnosed = [](stand_in::Problem problem) {
    int held_out = 0;
    for (calibrator::Measurement& measurement : problem.calibration.measurements) {
      if (measurement.experiment.name != "oedo") continue;
      measurement.role = calibrator::Role::held_out;
      ++held_out;
    }
    REQUIRE(held_out >= 2);
    return stand_in::diagnose(problem);
  };
  const Diagnosis missed = diagnosed(stand_in::make_problem(21, {{"hysteresis", 0.9}}));
  CHECK(missed.verdict == DiagnosisVerdict::not_predicted);
  CHECK(missed.p_held_out < 0.005);
  CHECK(missed.sentence.find("Let them be fitted") != std::string::npos);

  const Diagnosis met = diagnosed(stand_in::make_problem(3, {}));
  CHECK(met.verdict == DiagnosisVerdict::adequate);
  CHECK(met.p_held_out > 0.05);
  CHECK(met.p_held_out < 1.0);
}

TEST_CASE("a diagnosis asked twice has the same answer to the bit; strengths keep their limits",
          "[calibrator]") {
  const auto problem = stand_in::make_problem(11, {{"weaken", 0.9}});
  const Diagnosis once = stand_in::diagnose(problem), again = stand_in::diagnose(problem);
  REQUIRE(once.refits.size() == again.refits.size());
  for (std::size_t i = 0; i < once.refits.size(); ++i) {
    CHECK(once.refits[i].deviance == again.refits[i].deviance);
    CHECK(once.refits[i].strengths == again.refits[i].strengths);
  }
  for (const calibrator::Refit& refit : once.refits) {
    if (refit.effects.size() != 1) continue;
    CHECK(refit.strength_lower.front() <= refit.strengths.front());
    CHECK(refit.strengths.front() <= refit.strength_upper.front());
  }
  CHECK(once.p_named == again.p_named);
}

TEST_CASE("effects with one trace are reported as a family", "[calibrator]") {
  stand_in::Settings wet;
  wet.readings = stand_in::at_moisture(18.0);
  const auto problem = stand_in::make_problem(5, {{"jkr", 0.9}}, wet);
  const Diagnosis diagnosis = stand_in::diagnose(problem);
  REQUIRE(diagnosis.verdict == DiagnosisVerdict::family);
  CHECK(diagnosis.grade != calibrator::Grade::a);
  CHECK(diagnosis.sentence.find("capillary") != std::string::npos);
  CHECK(diagnosis.sentence.find("jkr") != std::string::npos);
}

TEST_CASE("a name is sure only where more than one apparatus asks for it", "[calibrator]") {
  const Diagnosis several = stand_in::diagnose(stand_in::make_problem(2, {{"capillary", 0.9}}));
  REQUIRE(named(several) == "capillary");
  CHECK(several.grade == calibrator::Grade::a);
  const Diagnosis one = stand_in::diagnose(stand_in::make_problem(21, {{"hysteresis", 0.9}}));
  REQUIRE(named(one) == "hysteresis");
  CHECK(one.grade == calibrator::Grade::b);
  CHECK(one.sentence.find("one apparatus alone") != std::string::npos);
}

TEST_CASE("a calibration of a few runs at one point is diagnosed as any other", "[calibrator]") {
  auto problem = stand_in::make_problem(7, {{"hysteresis", 0.8}});
  const calibrator::Suite suite(problem.calibration.measurements);
  problem.fit.history.clear();
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    std::vector<engine::Trial> trials;
    suite.append_trials(problem.fit.best, {}, seed, trials);
    calibrator::HistoryPoint point;
    point.stage = "confirm";
    point.parameters = problem.fit.best;
    point.values = suite.read(stand_in::evaluator(problem)(trials));
    problem.fit.history.push_back(std::move(point));
  }
  const Diagnosis diagnosis = stand_in::diagnose(problem);
  CHECK(diagnosis.freedom > 20.0);  // of twenty-six readings
  CHECK(diagnosis.fitted_z < 5.0);
  CHECK(named(diagnosis) == "hysteresis");
}

TEST_CASE("where no run gives a measurement nothing is said of the model", "[calibrator]") {
  auto problem = stand_in::make_problem(3, {});
  problem.fit.history.clear();
  const auto silent = [](std::span<const engine::Trial> trials) {
    std::vector<engine::Evaluation> evaluations;
    for (const engine::Trial& trial : trials) {
      evaluations.push_back({trial, std::vector<engine::Observation>{}, {}});
    }
    return evaluations;
  };
  const auto diagnosis = calibrator::diagnose(stand_in::question_of(problem), silent);
  REQUIRE(diagnosis.has_value());
  CHECK(diagnosis->verdict == DiagnosisVerdict::not_testable);
  CHECK(diagnosis->sentence.find("Nothing can be said") != std::string::npos);
  CHECK(diagnosis->evaluations == 30);  // and no probe was paid for
}

TEST_CASE("a stopped diagnosis has no answer", "[calibrator]") {
  const auto problem = stand_in::make_problem(1, {});
  std::stop_source stop;
  stop.request_stop();
  const auto question = stand_in::question_of(problem);
  CHECK_FALSE(
      calibrator::diagnose(question, stand_in::evaluator(problem), stop.get_token()).has_value());
}
