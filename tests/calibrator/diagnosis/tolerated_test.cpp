#include "calibrator/diagnosis/tolerated.hpp"

#include <string>
#include <utility>
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

TEST_CASE("an allowance larger than the tolerance takes its place", "[calibrator]") {
  Measurement kettle;
  kettle.experiment.name = "kettle";
  kettle.observable = "bulk_density";
  kettle.value = 700.0;
  kettle.standard_error = 3.0;
  std::vector<Measurement> kettles(2, kettle);
  const auto variances = [&] {
    const Eigen::MatrixXd covariance = covariance_of(kettles, {});
    return std::pair(covariance(0, 0), covariance(0, 1));
  };
  CHECK(variances().first == Approx(3.0 * 3.0 + 7.0 * 7.0));  // right codes differ by 1 %
  CHECK(variances().second == Approx(0.75 * 7.0 * 7.0));
  kettles[0].allowance = 7.0;  // the same, stated
  CHECK(variances().first == Approx(3.0 * 3.0 + 7.0 * 7.0));
  kettles[0].allowance = 21.0;
  CHECK(variances().first == Approx(3.0 * 3.0 + 21.0 * 21.0));
  CHECK(variances().second == Approx(0.75 * 7.0 * 7.0));
  CHECK(model_error_of(kettles[0], {{"kettle.bulk_density", 0.05}}) == Approx(35.0));
}
