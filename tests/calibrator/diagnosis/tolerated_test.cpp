#include "calibrator/diagnosis/tolerated.hpp"

#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "calibrator/diagnosis/covariance.hpp"
#include "tests/support/stand_in.hpp"

using namespace repose;
using namespace repose::calibrator;

TEST_CASE("the calibration's own runs tell whether a set of the model fits", "[calibrator]") {
  const auto right = stand_in::make_problem(3, {});
  const auto fitting = tolerated(right.calibration, right.fit, {});
  REQUIRE(fitting.has_value());
  CHECK(fitting->p > 0.05);
  CHECK(fitting->freedom > 15.0);  // of twenty-six readings and five parameters
  const std::string said = sentence_of(right.calibration, *fitting);
  CHECK(said.find("\"allowance\": \"tolerance\"") != std::string::npos);
  CHECK(said.find("stand_in.u4 ") != std::string::npos);

  const auto lacking = stand_in::make_problem(7, {{"hysteresis", 0.8}});
  const auto missed = tolerated(lacking.calibration, lacking.fit, {});
  REQUIRE(missed.has_value());
  CHECK(missed->p < 0.001);
  CHECK(sentence_of(lacking.calibration, *missed).find("Nor do its runs") == 0);
}

TEST_CASE("from too few runs no set is promised", "[calibrator]") {
  auto problem = stand_in::make_problem(3, {});
  problem.fit.history.resize(2);
  CHECK_FALSE(tolerated(problem.calibration, problem.fit, {}).has_value());
}

TEST_CASE("an allowance takes the place of the spread between codes", "[calibrator]") {
  Measurement kettle;
  kettle.experiment.name = "kettle";
  kettle.observable = "bulk_density";
  kettle.value = 700.0;
  kettle.standard_error = 3.0;
  CHECK(tolerance_of(kettle, {}) == Approx(0.01));
  kettle.allowance = 21.0;
  CHECK(tolerance_of(kettle, {}) == Approx(0.03));
  CHECK(covariance_of(std::vector{kettle}, {})(0, 0) == Approx(3.0 * 3.0 + 21.0 * 21.0));
  CHECK(tolerance_of(kettle, {{"kettle.bulk_density", 0.002}}) == 0.002);
}
