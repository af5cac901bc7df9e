#include "server/json/diagnosis_json.hpp"

#include <catch2/catch.hpp>

#include "engine/unit.hpp"

using namespace repose;
using calibrator::Calibration;
using calibrator::Diagnosis;

namespace {

/// An effect is open beside the model as it is, and a drum at another speed would settle it.
Diagnosis open_question() {
  Diagnosis diagnosis;
  diagnosis.verdict = calibrator::DiagnosisVerdict::named;
  diagnosis.grade = calibrator::Grade::b;
  diagnosis.effects.push_back({.suspect = {.name = "air_drag", .title = "Air drag", .levers = {}},
                               .status = calibrator::EffectStatus::outdone});
  diagnosis.rivals = {{0}, {}};
  calibrator::DecidingMeasurement next;
  next.experiment.name = "drum";
  next.experiment.settings["speed"] = 0.5;
  next.observable = "dynamic_angle";
  next.unit = engine::unit::degree;
  next.standard_error = 0.01;
  next.predicted = {0.6, 0.5};
  next.evidence = 25.0;
  next.gain = 3.0;
  diagnosis.next.push_back(next);
  diagnosis.evaluations = 42;
  return diagnosis;
}

}  // namespace

TEST_CASE("a diagnosis is read as it was printed, what would settle it included", "[server]") {
  const Calibration calibration;
  const Diagnosis written = open_question();
  const auto read =
      server::parse_diagnosis(calibration, server::print_diagnosis(calibration, {}, written));
  REQUIRE(read);
  CHECK(read->verdict == written.verdict);
  CHECK(read->effects.front().status == calibrator::EffectStatus::outdone);
  CHECK(read->rivals == written.rivals);
  REQUIRE(read->next.size() == 1);
  const calibrator::DecidingMeasurement& next = read->next.front();
  CHECK(next.experiment.name == "drum");
  CHECK(next.experiment.settings.at("speed") == Approx(0.5));
  CHECK(next.predicted[0] == Approx(0.6));
  CHECK(next.predicted[1] == Approx(0.5));
  CHECK(next.standard_error == Approx(0.01));
  CHECK(next.unit == engine::unit::degree);
  CHECK(next.evidence == 25.0);
}
