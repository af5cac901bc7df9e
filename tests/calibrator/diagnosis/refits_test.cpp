#include "calibrator/diagnosis/refits.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

using namespace repose::calibrator;
using Eigen::VectorXd;

TEST_CASE("strengths are looked for up to one, to either side where they have two signs",
          "[calibrator]") {
  const ModelSpace space{VectorXd::Constant(1, -largest_strength),
                         VectorXd::Constant(1, largest_strength),
                         VectorXd::Zero(1),
                         VectorXd::Ones(1)};
  double least = 0.0, most = 0.0;
  for (const SuiteRuns::Point& point : spread(space, {0}, 50, 1, 1)) {
    least = std::min(least, point.strengths.at(0));
    most = std::max(most, point.strengths.at(0));
  }
  CHECK(least >= -1.0);
  CHECK(least < -0.9);
  CHECK(most <= 1.0);
  CHECK(most > 0.9);
}
