#include "server/report/report.hpp"

#include <limits>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "server/cli/next_command.hpp"
#include "server/cli/summary.hpp"
#include "server/report/chart.hpp"
#include "server/report/number_text.hpp"
#include "server/report/svg.hpp"
#include "server/report/words.hpp"

using namespace repose;
using calibrator::Calibration;
using calibrator::Fit;
using calibrator::Measurement;
using Catch::Contains;
using server::print_report;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

Measurement measured(const char* experiment, const char* observable, double value, double error) {
  Measurement measurement;
  measurement.experiment.name = experiment;
  measurement.observable = observable;
  measurement.value = value;
  measurement.standard_error = error;
  return measurement;
}

/// Two measurements, one free parameter that the data fix and one that they do not.
server::CalibrationDocument sample() {
  using enum engine::MaterialId;
  Calibration calibration;
  calibration.name = "soybean";
  const auto friction = engine::make_key("sliding_friction.coefficient", {grain, grain});
  const auto rolling = engine::make_key("rolling_resistance.coefficient", {grain, grain});
  calibration.free = {{friction, 0.1, 0.9, calibrator::Scale::linear, engine::unit::one},
                      {rolling, 0.005, 0.3, calibrator::Scale::log, engine::unit::one}};
  calibration.measurements = {measured("kettle", "bulk_density", 720.0, 7.0),
                              measured("tilting_box", "static_angle", 0.541, 0.0175)};
  calibration.measurements[0].unit = engine::unit::kilogram_per_cubic_metre;
  calibration.measurements[1].unit = engine::unit::degree;

  Fit fit;
  fit.best.set(friction, 0.45);
  fit.best.set(rolling, 0.05);
  fit.parameters = {{friction, 0.45, 0.40, 0.52, false, false, 0.93, true},
                    {rolling, 0.05, 0.005, 0.21, true, false, 0.3, false}};
  fit.directions = {{{0.95, 0.31}, 0.1, true}, {{-0.31, 0.95}, 0.9, false}};
  calibrator::Prediction kettle, box;
  kettle.measurement = 0;
  kettle.predicted = 716.0;
  kettle.standard_error = 2.0;
  kettle.z = -0.55;
  box.measurement = 1;
  box.predicted = 0.550;
  box.standard_error = 0.005;
  box.z = 0.49;
  fit.predictions = {kettle, box};
  fit.misfit = 0.54;
  fit.evaluations = 30;
  fit.stop = calibrator::StopReason::hit;
  for (int i = 1; i <= 6; ++i) {
    fit.history.push_back(
        {i, i < 4 ? "start" : "search", {}, {}, i == 2 ? none : 80.0 / i, 60.0 / i});
  }
  return {17, "soybean", "finished", "", "", "", "", "0.1.0+test", calibration, fit, "{}"};
}

std::string report(const server::CalibrationDocument& document) {
  return print_report(document, {}, {"repose 0.1.0", "/tmp/repose.db", "2026-01-01T00:00:00Z"});
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
  return found;
}

}  // namespace

TEST_CASE("user text is escaped in the report", "[server]") {
  auto document = sample();
  document.name = "<script>alert(\"1\")</script> & 'co'";
  document.calibration->measurements[0].source = "<b>Boac</b>";
  document.fit->remarks = {"a < b & c > d"};
  document.study = "{\"name\": \"</pre><script>\"}";
  const std::string html = report(document);
  CHECK(html.find("<script") == std::string::npos);
  CHECK(html.find("<b>Boac") == std::string::npos);
  CHECK_THAT(html,
             Contains("&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt; &amp; &#39;co&#39;"));
  CHECK_THAT(html, Contains("a &lt; b &amp; c &gt; d"));
}

TEST_CASE("the report needs nothing from elsewhere", "[server]") {
  auto document = sample();
  const std::string html = print_report(
      document,
      std::vector<server::ReportPicture>{{"kettle, filled", "1 grain", {1, 1, {1, 2, 3, 255}}}},
      {});
  CHECK(count(html, "http://") + count(html, "https://") + count(html, "src=\"/") == 0);
  CHECK(count(html, "<script") + count(html, "@import") + count(html, "<link") == 0);
  CHECK(count(html, "src=\"data:image/png;base64,") == 1);
}

TEST_CASE("the report shows every measurement with value, prediction and difference", "[server]") {
  const std::string html = report(sample());
  CHECK_THAT(html, Contains("kettle: bulk density"));
  CHECK_THAT(html, Contains("720.0 ± 7.0 kg/m3"));
  CHECK_THAT(html, Contains("716.0 ± 2.0 kg/m3"));
  CHECK_THAT(html, Contains("tilting box: static angle"));
  CHECK_THAT(html, Contains("31.0 ± 1.0 deg"));
  CHECK_THAT(html, Contains("-0.55"));
}

TEST_CASE("an allowance is shown as a warning", "[server]") {
  auto document = sample();
  document.calibration->measurements[0].allowance = 12.0;
  CHECK_THAT(report(document), Contains("class=\"warning\">allowance 12 kg/m3"));
}

TEST_CASE("an undetermined parameter looks different from a determined one", "[server]") {
  const auto document = sample();
  const std::string chart = server::interval_chart(*document.calibration, *document.fit);
  CHECK(count(chart, "interval undetermined") == 1);
  CHECK(count(chart, "not determined: 0.005 to 0.21") == 1);
  CHECK(count(chart, "0.45  (0.4 to 0.52)") == 1);
}

TEST_CASE("the headline says whether the measurements are met", "[server]") {
  auto document = sample();
  const auto said = [&] { return server::headline(*document.calibration, *document.fit); };
  CHECK(said() == "Both measurements are met within one standard error.");
  document.fit->predictions[0].z = 1.4;
  CHECK(said() == "Both measurements are met within two standard errors.");
  document.fit->predictions[0].z = -3.1;
  CHECK(said() ==
        "1 of 2 measurements is missed by more than two standard errors: kettle: bulk "
        "density (z = -3.1).");
  document.fit->predictions[0].z = none;
  CHECK_THAT(said(), Contains("kettle: bulk density (no prediction)"));
}

TEST_CASE("a held-out measurement counts neither as hit nor as missed", "[server]") {
  auto document = sample();
  document.calibration->measurements[0].role = calibrator::Role::held_out;
  document.fit->predictions[0].z = 9.0;
  CHECK(server::headline(*document.calibration, *document.fit) ==
        "The measurement is met within one standard error.");
  CHECK_THAT(report(document),
             Contains("Set aside and predicted within two standard errors: 0 of 1"));
}

TEST_CASE("a fit that misses names the commands that tell more, one that does not none",
          "[server]") {
  auto document = sample();
  CHECK(server::after_fit(document, "r.db").empty());
  document.id = 6;
  document.fit->predictions[0].z = 9.0;
  CHECK(server::after_fit(document, "my r.db") ==
        "Next: `repose compare 6 --db 'my r.db'` shows where the model misses, "
        "`repose diagnose 6 --db 'my r.db'` which effect it lacks.\n");
  document.fit.reset();
  CHECK(server::after_fit(document, "r.db").empty());
}

TEST_CASE("a diagnosis that names an effect names the command that adds it", "[server]") {
  calibrator::Diagnosis diagnosis;
  diagnosis.effects.resize(2);
  diagnosis.effects[1].suspect.name = "air_drag";
  diagnosis.refits.resize(1);
  diagnosis.refits[0].effects = {1};
  const auto next = [&](calibrator::DiagnosisVerdict verdict) {
    diagnosis.verdict = verdict;
    return server::after_diagnosis(6, diagnosis, "r.db");
  };
  using enum calibrator::DiagnosisVerdict;
  CHECK(next(named) ==
        "Next: `repose extend 6 --effect air_drag --db r.db` adds it and calibrates again.\n");
  CHECK(next(adequate).empty());
  CHECK(next(unexplained).empty());
  diagnosis.refits[0].effects = {1, 0};
  CHECK_THAT(next(pair), Contains("--effect air_drag") && Contains("the first of them"));
}

TEST_CASE("what was not learnt is said in words", "[server]") {
  const auto document = sample();
  const std::string text = server::print_summary(document);
  CHECK_THAT(text,
             Contains("Not determined by the data: rolling resistance (grain-grain), anything from "
                      "0.005 to 0.21"));
  CHECK_THAT(text, Contains("1 combination of the 2 free parameters was learnt."));
  CHECK_THAT(text, Contains("rolling_resistance.coefficient:grain-grain"));
}

TEST_CASE("parameters that are each open by themselves are not called a trade", "[server]") {
  auto document = sample();
  const auto said = [&] { return server::print_summary(document); };
  CHECK_FALSE(Contains("too little to be told").match(said()));  // the open one is rolling's
  document.fit->directions[1].components = {-0.7, 0.71};
  CHECK_THAT(said(),
             Contains("More sliding friction (grain-grain) with less rolling resistance "
                      "(grain-grain), or the reverse, changes the measurements too little"));
  document.fit->directions[0] = {{0.71, 0.7}, 0.9, false};
  CHECK_FALSE(Contains("too little to be told").match(said()));
}

TEST_CASE("a calibration without a fit still has a report", "[server]") {
  auto document = sample();
  document.fit.reset();
  document.state = "failed";
  document.error = "the disk is <full>";
  CHECK_THAT(report(document), Contains("the disk is &lt;full&gt;"));
}

TEST_CASE("a failed evaluation is marked in the convergence chart", "[server]") {
  const auto document = sample();
  const std::string chart = server::convergence_chart(*document.calibration, *document.fit);
  CHECK(count(chart, "class=\"failed\"") == 2);            // the two strokes of one cross
  CHECK(count(chart, "class=\"stage search\"") == 3 + 1);  // points and the legend
  CHECK(chart.find("nan") == std::string::npos);
}

TEST_CASE("no chart holds a number that is none", "[server]") {
  auto document = sample();
  document.fit->predictions[0].z = none;
  document.fit->predictions[0].predicted = none;
  document.fit->history.clear();
  const std::string html = report(document);
  CHECK(html.find("nan") == std::string::npos);
  CHECK(html.find("inf\"") == std::string::npos);
}

TEST_CASE("numbers are printed with the digits they carry", "[server]") {
  using engine::unit::degree;
  using engine::unit::megapascal;
  CHECK(server::number_text(0.0) == "0");
  CHECK(server::number_text(1228.0) == "1228");
  CHECK(server::number_text(0.45000000001) == "0.45");
  CHECK(server::number_text(-0.00012345, 3) == "-0.000123");
  CHECK(server::number_text(none) == "-");
  CHECK(server::number_text(std::numeric_limits<double>::infinity()) == "inf");
  CHECK(server::decimals_for(none, none) == 0);
  CHECK(server::with_error(1.04e6, 0.02e6, megapascal) == "1.040 ± 0.020 MPa");
  CHECK(server::with_error(32.1 * degree.factor, none, degree) == "32.10 deg");
  CHECK(server::count_text(1234567) == "1 234 567");
  CHECK(server::duration_text(200.0) == "3 min 20 s");
}

namespace {

/// The sample with a curve of two points, samples of the posterior and something to measure next.
server::CalibrationDocument with_curve() {
  auto document = sample();
  for (const double speed : {1.0, 2.0}) {
    Measurement point = measured("drum", "dynamic_angle", 0.5 + 0.02 * speed, 0.01);
    point.experiment.settings["speed"] = speed;
    point.unit = engine::unit::degree;
    point.curve = 1;
    point.allowance = 0.0174533;
    calibrator::Prediction prediction;
    prediction.measurement = document.calibration->measurements.size();
    prediction.predicted = point.value + 0.01;
    prediction.standard_error = 0.002;
    prediction.z = speed == 1.0 ? 3.0 : 4.0;
    document.calibration->measurements.push_back(point);
    document.fit->predictions.push_back(prediction);
  }
  document.fit->directions[0].powers = {1.0, 0.4};
  document.fit->directions[0].product_error = 0.062;
  document.fit->posterior.samples = {{0.4, 0.02}, {0.5, 0.1}};
  document.fit->posterior.quantiles = {{0.41, 0.45, 0.51}, {0.006, 0.05, 0.2}};
  document.fit->next = {{{"tilting_box", {}, {}}, "onset_angle", false, 0.4, 0.0175, 0.7, 1, 0.65}};
  return document;
}

}  // namespace

TEST_CASE("a curve is one line of the table and one chart, its allowance in the warning's colour",
          "[server]") {
  const std::string html = report(with_curve());
  CHECK(count(html, "<tr><td>drum: dynamic angle, 2 points along speed") == 1);
  CHECK_THAT(html, Contains("3.54 rms"));  // of z = 3 and 4
  CHECK_THAT(html, Contains("<small class=\"warning\">allowance 1 deg"));
  CHECK(count(html, ">drum: dynamic angle, 2 points along speed</text>") == 1);
  CHECK_THAT(server::print_summary(with_curve()), Contains("2 points along speed"));
}

TEST_CASE("what was learnt is told as a product, with what to measure next", "[server]") {
  const auto document = with_curve();
  const std::string text = server::print_summary(document);
  CHECK_THAT(text,
             Contains("the data fix sliding friction (grain-grain) × rolling resistance "
                      "(grain-grain)^0.4 to 6.2 %."));
  CHECK_THAT(text,
             Contains("tilting box: onset angle, to ± 1 deg: most about rolling resistance "
                      "(grain-grain), learnt to 65 % instead of 30 %."));
  const std::string html = report(document);
  CHECK_THAT(html, Contains("What to measure next"));
  CHECK(count(html, "class=\"speck\"") == 2);
  CHECK_THAT(html, Contains("0.006 to 0.2"));  // 90 % of the posterior
}
