#include "calibrator/diagnosis/suite_runs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/support/stand_in.hpp"

using namespace repose;
using calibrator::SuiteRun;
using calibrator::SuiteRuns;
using calibrator::UnitPoint;

namespace {

std::size_t index_of(const stand_in::Problem& problem, const std::string& suspect) {
  const auto found = std::ranges::find(problem.suspects, suspect, &calibrator::Suspect::name);
  return static_cast<std::size_t>(found - problem.suspects.begin());
}

std::size_t reading_of(const stand_in::Problem& problem, const std::string& observable) {
  const auto& all = problem.calibration.measurements;
  const auto found = std::ranges::find(all, observable, &calibrator::Measurement::observable);
  return static_cast<std::size_t>(found - all.begin());
}

/// The stand-in, with a count of what it was asked.
struct Counted {
  stand_in::Problem problem = stand_in::make_problem(2, {});
  std::map<std::string, int> asked;
  calibrator::Evaluator evaluator = [this](std::span<const engine::Trial> trials) {
    for (const engine::Trial& trial : trials) ++asked[trial.experiment.name];
    return stand_in::evaluator(problem)(trials);
  };
  SuiteRuns runs{problem.calibration, problem.suspects, evaluator, problem.fit};
  std::size_t tap = index_of(problem, "tap");
  UnitPoint at = UnitPoint(5, 0.5);

  /// A run without suspects and one with the kettle tapped, of one seed.
  void compare() {
    runs.run(std::vector<SuiteRuns::Point>{{at, {}}});
    runs.run(std::vector<SuiteRuns::Point>{{at, {{tap, 0.8}}, runs.all().back().seed}});
  }
};

}  // namespace

TEST_CASE("experiments that a suspect leaves as they were to the last bit are not run for it again",
          "[calibrator]") {
  Counted counted;
  counted.compare();
  REQUIRE(counted.asked["tiltbox"] == 2 * 3);  // at three moistures
  counted.asked.clear();
  counted.runs.run(std::vector<SuiteRuns::Point>{{UnitPoint(5, 0.3), {{counted.tap, 0.5}}}});
  CHECK(counted.asked["kettle"] == 3);
  CHECK(counted.asked["oedo"] == 3);
  CHECK(counted.asked["tiltbox"] == 0);
  CHECK(counted.asked["drum"] == 0);
  CHECK(counted.asked["hopper"] == 0);
}

TEST_CASE("one suspect that touches an experiment has it run for all that are on", "[calibrator]") {
  Counted counted;
  counted.compare();
  counted.asked.clear();
  const std::size_t jkr = index_of(counted.problem, "jkr");
  counted.runs.run(std::vector<SuiteRuns::Point>{{counted.at, {{counted.tap, 0.5}, {jkr, 0.5}}}});
  CHECK(counted.asked["tiltbox"] == 3);
}

TEST_CASE("a run that only repeated another with the same seed is not counted as a second",
          "[calibrator]") {
  Counted counted;
  counted.compare();
  const SuiteRun& run = counted.runs.all().back();
  CHECK(std::isfinite(run.values[reading_of(counted.problem, "density")]));
  CHECK(std::isnan(run.values[reading_of(counted.problem, "static_angle")]));
}

TEST_CASE("what a suspect does not touch is learnt from the runs without it", "[calibrator]") {
  Counted counted;
  counted.compare();
  const std::vector<std::size_t> on{counted.tap};
  const SuiteRuns::Table table = counted.runs.table(on);
  const std::size_t density = reading_of(counted.problem, "density");
  const std::size_t angle = reading_of(counted.problem, "static_angle");
  CHECK(table.heard[density].size() == 6);
  CHECK(table.heard[angle].size() == 5);
}

TEST_CASE("a suspect is taken to touch everything until it has been seen", "[calibrator]") {
  Counted counted;
  CHECK(counted.runs.touches(counted.tap, reading_of(counted.problem, "static_angle")));
  counted.runs.run(std::vector<SuiteRuns::Point>{{counted.at, {{counted.tap, 0.8}}}});
  CHECK(counted.asked["tiltbox"] == 3);
}
