#include "calibrator/comparison.hpp"

#include <cmath>

#include <catch2/catch.hpp>

using namespace repose;
using namespace repose::calibrator;

namespace {

struct Drop {
  double height;  // m
  double measured, predicted;
  Role role = Role::fit;
};

/// Drops with a standard error of 0.01, and a fit that learnt one direction.
Comparison compared(const std::vector<Drop>& drops, double tolerance = 0.0, int replicates = 0) {
  Calibration calibration;
  Fit fit;
  fit.directions.push_back({{1.0}, 0.1, true});
  for (const Drop& drop : drops) {
    Measurement measurement;
    measurement.experiment = {"drop", engine::Fidelity::draft, {{"height", drop.height}}};
    measurement.observable = "restitution";
    measurement.value = drop.measured;
    measurement.standard_error = 0.01;
    measurement.replicates = replicates;
    measurement.role = drop.role;
    calibration.measurements.push_back(measurement);
    Prediction prediction;
    prediction.measurement = fit.predictions.size();
    prediction.predicted = drop.predicted;
    fit.predictions.push_back(prediction);
  }
  return compare(calibration, fit, {{"drop.restitution", tolerance}});
}

bool says(const Comparison& comparison, const std::string& words) {
  for (const std::string& sentence : comparison.sentences) {
    if (sentence.find(words) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("a miss is said in words, with its place", "[calibrator]") {
  const Comparison comparison =
      compared({{0.05, 0.75, 0.70}, {0.2, 0.70, 0.70}, {0.6, 0.64, 0.70}, {0.3, 0.69, 0.70}});
  REQUIRE(comparison.sentences.size() == 2);
  CHECK(comparison.sentences[0] ==
        "The model's restitution (drop) is 0.05 too low at 50 mm and 0.06 too high at 600 mm.");
  CHECK(says(comparison, "does not fit"));
  REQUIRE(comparison.trends.size() == 1);
  CHECK(comparison.trends[0].slope > 0.0);
}

TEST_CASE("a model that fits is told to fit", "[calibrator]") {
  const Comparison comparison =
      compared({{0.05, 0.70, 0.70}, {0.2, 0.71, 0.70}, {0.6, 0.69, 0.70}});
  REQUIRE(comparison.sentences.size() == 1);
  CHECK(says(comparison, "The model fits"));
  CHECK(comparison.misfit == Approx(2.0));
  CHECK(comparison.freedom == 2.0);
  CHECK(comparison.p == Approx(std::exp(-1.0)).epsilon(1e-6));  // of two degrees of freedom
}

TEST_CASE("many small misses are no fit", "[calibrator]") {
  const std::vector<Drop> drops{{0.05, 0.718, 0.70},
                                {0.1, 0.718, 0.70},
                                {0.2, 0.682, 0.70},
                                {0.4, 0.682, 0.70},
                                {0.8, 0.718, 0.70}};
  const Comparison comparison = compared(drops);
  REQUIRE(comparison.sentences.size() == 1);
  CHECK(says(comparison, "does not fit"));
  // Errors from three repetitions are too small as often as not.
  const Comparison uncertain = compared(drops, 0.0, 3);
  CHECK(uncertain.misfit == Approx(comparison.misfit));
  CHECK(uncertain.p > 0.05);
  CHECK_FALSE(says(uncertain, "does not fit"));
}

TEST_CASE("a tolerance that readings share hides no trend between them", "[calibrator]") {
  const Comparison comparison =
      compared({{0.05, 0.70, 0.68}, {0.1, 0.70, 0.69}, {0.2, 0.70, 0.71}, {0.4, 0.70, 0.72}}, 0.05);
  REQUIRE(comparison.trends.size() == 1);
  // By hand: what is not shared is the standard error and a quarter of the tolerance's square.
  const double own = std::sqrt(0.01 * 0.01 + 0.25 * std::pow(0.05 * 0.70, 2));
  CHECK(comparison.trends[0].z == Approx(0.07 / std::sqrt(5.0) / own).epsilon(1e-6));
}

TEST_CASE("as many parameters as measurements say nothing", "[calibrator]") {
  CHECK(says(compared({{0.05, 0.7, 0.7}}), "says nothing"));
  // But a miss is one, however many were learnt.
  const Comparison off = compared({{0.05, 0.7, 0.6}});
  CHECK(off.p < 1e-6);
  CHECK(says(off, "The model does not fit"));
  CHECK_FALSE(says(off, "says nothing"));
}

TEST_CASE("a measurement held out is named as such and not counted", "[calibrator]") {
  const Comparison comparison = compared({{0.05, 0.70, 0.70},
                                          {0.2, 0.70, 0.70},
                                          {0.4, 0.69, 0.70},
                                          {0.6, 0.60, 0.70, Role::held_out}});
  CHECK(says(comparison, "(held out)"));
  CHECK(comparison.misfit == Approx(1.0));
  CHECK(comparison.held_out_z == Approx(10.0));
}
