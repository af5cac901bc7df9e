#include "server/report/lineage_report.hpp"

#include <limits>
#include <string>

#include <catch2/catch.hpp>

#include "server/report/chart_lineage.hpp"
#include "server/report/diagnosis_words.hpp"

using namespace repose;
using namespace repose::server;
using calibrator::EffectStatus;
using Catch::Contains;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
const engine::ParameterKey restitution{"restitution.coefficient",
                                       {engine::MaterialId::grain, engine::MaterialId::wall}};
const engine::ParameterKey share{"air_drag.share", {}};

/// Drops from four heights, the last held out, predicted off by these numbers of standard errors.
Generation model(std::int64_t id, const std::vector<double>& z, bool with_drag) {
  calibrator::Calibration calibration;
  calibration.name = "balls & <boxes>";
  calibration.free.push_back({restitution, 0.3, 0.9, calibrator::Scale::linear, engine::unit::one});
  calibrator::Fit fit;
  fit.parameters.push_back({restitution, 0.7, 0.65, 0.75, false, false, 0.9, true});
  fit.directions.push_back({{1.0}, 0.1, true});
  if (with_drag) {
    calibration.extends = calibrator::Extension{1, 1, "air_drag"};
    calibration.free.push_back({share, 0.0, 1.3, calibrator::Scale::linear, engine::unit::one});
    fit.parameters.push_back({share, 0.9, 0.5, 1.3, false, true, 0.8, false});
    fit.directions = {{{0.9, 0.1}, 0.1, true}, {{0.1, 0.9}, 0.4, true}};
  }
  const double heights[] = {0.1, 0.3, 1.0, 1.5};
  for (std::size_t i = 0; i < z.size(); ++i) {
    calibrator::Measurement measurement;
    measurement.experiment = {"drop", engine::Fidelity::draft, {{"height", heights[i]}}};
    measurement.observable = "restitution";
    measurement.value = 0.7;
    measurement.standard_error = 0.01;
    if (i == 3) measurement.role = calibrator::Role::held_out;
    calibration.measurements.push_back(measurement);
    calibrator::Prediction prediction;
    prediction.measurement = i;
    prediction.predicted = 0.7 + 0.01 * z[i];
    prediction.standard_error = 0.001;
    fit.predictions.push_back(prediction);
  }
  Generation generation{{}, {}, {}, 0};
  generation.document.id = id;
  generation.document.name = calibration.name;
  generation.document.calibration = calibration;
  generation.document.fit = fit;
  generation.comparison = calibrator::compare(calibration, fit, {{"drop.restitution", 0.0}});
  return generation;
}

calibrator::EffectFinding finding(const char* name, const char* title, EffectStatus status) {
  calibrator::EffectFinding result;
  result.suspect.name = name;
  result.suspect.title = title;
  result.status = status;
  result.change = {0.0, -0.01, -0.03, 0.0};
  result.trace = {0.5, -0.2, -1.5, none};
  return result;
}

Lineage sample() {
  Lineage lineage{model(1, {-4.0, 1.0, 5.0, 6.0}, false), model(2, {0.5, -0.5, 0.3, 1.0}, true)};
  calibrator::Diagnosis diagnosis;
  diagnosis.verdict = calibrator::DiagnosisVerdict::named;
  diagnosis.grade = calibrator::Grade::b;
  diagnosis.sentence = "Air drag is missing.";
  diagnosis.misfit = 42.0;
  diagnosis.effects = {finding("hysteresis", "Hysteresis", EffectStatus::not_testable),
                       finding("air_drag", "Air drag", EffectStatus::supported)};
  diagnosis.effects[0].absorbed = 0.99;
  diagnosis.effects[0].detectable = 4.0;
  diagnosis.effects[1].score = 30.0;
  diagnosis.effects[1].suspect.levers = {
      {.key = share, .null_value = 0.0, .strong = 1.0, .lower = 0.0, .upper = 2.0}};
  calibrator::Refit refit;
  refit.effects = {1};
  refit.strengths = {0.9};
  refit.strength_lower = {0.5};
  refit.strength_upper = {1.3};
  refit.gain = 40.0;
  refit.misfit = 1.2;
  refit.freedom = 1.0;
  diagnosis.refits = {refit};
  diagnosis.rivals = {{}, {1}};
  calibrator::DecidingMeasurement next;
  next.experiment = {"drop", engine::Fidelity::draft, {{"height", 2.0}}};
  next.observable = "restitution";
  next.standard_error = 0.01;
  next.predicted = {0.70, 0.62};
  next.evidence = 64.0;
  diagnosis.next = {next};
  lineage.front().diagnosis = diagnosis;
  return lineage;
}

std::string report(const Lineage& lineage) {
  return print_lineage_report(lineage, {"repose 0.1.0", "/tmp/a.db", "2026-01-01T00:00:00Z"});
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

}  // namespace

TEST_CASE("a lineage's report says what is missing and what adding it has done", "[server]") {
  const std::string text = report(sample());
  CHECK_THAT(text, Contains("Air drag is missing."));
  CHECK_THAT(text, Contains("<b class=\"badge\">B</b>"));
  CHECK_THAT(text, Contains("With air drag added"));
  CHECK_THAT(text, Contains("3.72 → 0.44"));  // root mean square of 4, 1, 5 and of .5, .5, .3
  CHECK_THAT(text, Contains("5.97 → 1.00"));  // held out
  CHECK_THAT(text, Contains("cannot test: Hysteresis"));
  CHECK_THAT(text, Contains("height 2000 mm"));  // to be measured next
  CHECK_THAT(text, Contains("with air drag") && Contains("0.620"));
}

TEST_CASE("a lineage's report needs nothing from elsewhere and closes what it opens", "[server]") {
  const std::string text = report(sample());
  for (const char* foreign : {"<script", "<link", "http://", "https://", "@import"}) {
    CHECK(text.find(foreign) == std::string::npos);
  }
  for (const std::string tag :
       {"section", "div", "svg", "table", "tr", "td", "p", "span", "i", "b"}) {
    CAPTURE(tag);
    CHECK(count(text, "<" + tag + ">") + count(text, "<" + tag + " ") ==
          count(text, "</" + tag + ">"));
  }
  CHECK(text.find("balls & <boxes>") == std::string::npos);
  CHECK_THAT(text, Contains("balls &amp; &lt;boxes&gt;"));
}

TEST_CASE("no chart of a lineage holds a number that is none", "[server]") {
  Lineage lineage = sample();
  lineage.back().comparison.rows[2].z = none;
  lineage.back().comparison.rows[2].predicted = none;
  const std::string text = report(lineage);
  CHECK(text.find("nan") == std::string::npos);
  CHECK(text.find("inf\"") == std::string::npos);
}

TEST_CASE("effects that change none of the measurements are named in one line, without figures",
          "[server]") {
  Lineage lineage = sample();
  auto& effects = lineage.front().diagnosis->effects;
  effects.push_back(finding("twisting_resistance", "Twisting", EffectStatus::not_testable));
  effects.back().change = {0.0, 0.0, none, 0.0};
  const std::string text = report(lineage);
  CHECK_THAT(text, Contains("Nothing to these measurements: Twisting."));
  CHECK(text.find("<td>Twisting") == std::string::npos);
}

TEST_CASE("a held-out measurement is drawn hollow under every model", "[server]") {
  const std::string charts = parity_panels(sample()) + trend_panels(sample());
  CHECK(count(charts, "model m0 hollow") == 2);  // one in each of the two
  CHECK(count(charts, "model m1 hollow") == 2);
}

TEST_CASE("a difference is coloured by its side and its depth", "[server]") {
  const std::string map = residual_map(sample());
  CHECK(count(map, "heat low d2") == 1);   // -4.0 by the first model, less its runs' error
  CHECK(count(map, "heat high d3") == 2);  // 5.0 and 6.0
  CHECK(count(map, "heat none") == 5);
}

TEST_CASE("a model by itself has a report too", "[server]") {
  const std::string text = report({model(1, {0.1, 0.2, -0.3, 0.1}, false)});
  CHECK_THAT(text, Contains("No diagnosis has been made"));
  CHECK(text.find("→") == std::string::npos);
}

TEST_CASE("from which strength on an effect would be found is said as far as that tells anything",
          "[server]") {
  Lineage lineage = sample();
  calibrator::EffectFinding& finding = lineage.front().diagnosis->effects[0];
  finding.absorbed = 0.2;
  CHECK_THAT(reason(*lineage.front().diagnosis, 0), Contains("from 4.0 times the strong value on"));
  CHECK(detectable_text(finding) == "4.00");
  finding.detectable = 117578.6;
  CHECK_THAT(reason(*lineage.front().diagnosis, 0), Contains("too little.") && !Contains("times"));
  CHECK(detectable_text(finding) == "> 10");
}

TEST_CASE("the reason for a status is said in the effect's own terms", "[server]") {
  const Lineage lineage = sample();
  const calibrator::Diagnosis& diagnosis = *lineage.front().diagnosis;
  CHECK_THAT(reason(diagnosis, 1), Contains("falls from 42.0 to 1.2") && Contains("share 0.9"));
  CHECK_THAT(reason(diagnosis, 0), Contains("imitate 99 %"));
  CHECK(ranked(diagnosis) == std::vector<std::size_t>{1, 0});
}
