#include "calibrator/diagnosis/objection.hpp"

#include <catch2/catch.hpp>

#include "engine/unit.hpp"

using namespace repose;
using calibrator::Calibration;
using calibrator::Direction;
using calibrator::Fit;
using calibrator::Measurement;

namespace {

Measurement drop_of(double value, double error, double height = 0.151) {
  Measurement measurement;
  measurement.experiment = {"drop", engine::Fidelity::standard, {{"height", height}}};
  measurement.observable = "restitution";
  measurement.value = value;
  measurement.standard_error = error;
  return measurement;
}

Fit learnt(int directions) {
  Fit fit;
  for (int k = 0; k < directions; ++k) fit.directions.push_back({{}, 0.1, true});
  fit.directions.push_back({{}, 0.9, false});
  return fit;
}

}  // namespace

TEST_CASE("more measurements than learnt directions are no objection", "[calibrator]") {
  Calibration calibration;
  calibration.measurements = {drop_of(0.6, 0.01), drop_of(0.59, 0.01, 0.3)};
  CHECK(calibrator::objections(calibration, learnt(1)).empty());
}

TEST_CASE("as many learnt directions as measurements: nothing is left to test, and what would help",
          "[calibrator]") {
  Calibration calibration;
  calibration.measurements = {drop_of(0.6, 0.01), drop_of(0.59, 0.01, 0.3)};
  calibration.measurements.back().role = calibrator::Role::held_out;  // is no help
  const auto found = calibrator::objections(calibration, learnt(1));
  REQUIRE(found.size() == 1);
  CHECK(found.front().find("1 measurement determined 1 direction") != std::string::npos);
  CHECK(found.front().find("heap") != std::string::npos);
  CHECK(found.front().find("drop,") == std::string::npos);
}

TEST_CASE("readings of one thing that are far apart contradict each other", "[calibrator]") {
  Calibration calibration;
  calibration.measurements = {drop_of(0.6, 0.01), drop_of(0.5, 0.01), drop_of(0.5, 0.01, 0.3)};
  // The default height, spelt out or not, is one height.
  calibration.measurements[1].experiment.settings.clear();
  const auto found = calibrator::objections(calibration, learnt(1));
  REQUIRE(found.size() == 1);
  CHECK(found.front().find("measurements 1 and 2 contradict") != std::string::npos);
  CHECK(found.front().find("0.6 and 0.5") != std::string::npos);
  calibration.measurements[1].standard_error = 0.03;  // 3.2 standard errors may be chance
  CHECK(calibrator::objections(calibration, learnt(1)).empty());
}

TEST_CASE("all objections are told at once, a missing standard error among them", "[calibrator]") {
  Calibration calibration;
  calibration.measurements = {drop_of(0.6, 0.01), drop_of(0.4, 0.0)};
  const auto found = calibrator::objections(calibration, learnt(2));
  REQUIRE(found.size() == 3);
  CHECK(found.back().find("measurement 2 (drop.restitution) has no standard error") !=
        std::string::npos);
}
