#include "calibrator/measurement.hpp"

#include <catch2/catch.hpp>

using namespace repose::calibrator;

namespace {

Measurement at_speed(double speed, int curve) {
  Measurement m;
  m.experiment.name = "drum";
  m.experiment.settings = {{"diameter", 0.1}, {"speed", speed}};
  m.observable = "dynamic_angle";
  m.curve = curve;
  return m;
}

}  // namespace

TEST_CASE("the points of a curve are one line, two curves are two", "[calibrator]") {
  const std::vector all{
      at_speed(1, 0), at_speed(1, 1), at_speed(2, 1), at_speed(1, 2), at_speed(3, 2)};
  const auto lines = lines_of(all);
  REQUIRE(lines.size() == 3);
  CHECK(lines[0].size() == 1);
  CHECK(lines[1].size() == 2);
  CHECK(lines[2].size() == 2);
  CHECK(setting_along(lines[1]) == "speed");
}
