#include "server/json/fit_json.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "server/json/calibration_json.hpp"
#include "server/json/report_json.hpp"
#include "server/json/text.hpp"

namespace {

using repose::calibrator::Calibration;
using repose::calibrator::Fit;
using repose::server::Json;
using repose::server::parse_fit;
using repose::server::print_calibration;
using repose::server::print_fit;
using repose::server::print_progress;
using repose::server::to_text;
namespace calibrator = repose::calibrator;
namespace engine = repose::engine;

Calibration calibration() {
  auto result = repose::server::parse_calibration(R"({
    "name": "two free",
    "materials": {
      "grain": {"density": {"value": 1228, "unit": "kg/m3"}, "diameter": {"value": 6.5, "unit": "mm"},
                "poisson_ratio": {"value": 0.25, "unit": "1"}},
      "wall": {"shear_modulus": {"value": 80, "unit": "GPa"}, "poisson_ratio": {"value": 0.3, "unit": "1"}}},
    "free": [{"field": "restitution.coefficient", "between": ["grain", "wall"], "lower": 30, "upper": 90, "unit": "%"},
             {"field": "material.shear_modulus", "between": ["grain"], "lower": 1, "upper": 10, "unit": "MPa", "scale": "log"}],
    "tied": [{"field": "restitution.coefficient", "between": ["grain", "grain"],
              "to": {"field": "restitution.coefficient", "between": ["grain", "wall"]}}],
    "measurements": [
      {"experiment": "tilting_box", "observable": "static_angle", "value": 31, "unit": "deg", "standard_error": 1},
      {"experiment": "drop", "settings": {"height": {"value": 30, "unit": "cm"}}, "observable": "restitution",
       "value": 0.6, "unit": "1", "standard_error": 0.02, "role": "held_out"}],
    "budget": {"fidelity": "draft", "confirm_fidelity": "standard"}})");
  REQUIRE(result);
  return std::move(result).value();
}

Fit fit() {
  constexpr double degree = engine::unit::degree.factor;
  const Calibration question = calibration();
  Fit result;
  result.best = question.fixed;
  result.best.set(question.free[0].key, 0.55);
  result.best.set(question.free[1].key, 2.5e6);
  result.best.set(question.tied[0].key, 0.55);
  result.parameters = {{question.free[0].key, 0.55, 0.5, 0.6, false, false, 0.97, true},
                       {question.free[1].key, 2.5e6, 1e6, 1e7, true, true, 0.1, false}};
  result.directions = {{{0.8, -0.6}, 0.1, true, {1.0, -0.25}, 0.06}, {{0.6, 0.8}, 0.98, false}};
  result.posterior = {
      {{0.5512345, 2.5e6}, {0.56, 3.5e6}}, {{0.5, 0.55, 0.6}, {1.2e6, 3e6, 9e6}}, 1.004, 1234};
  result.next = {
      {{"tilting_box", {}, {}}, "onset_angle", false, 0.4, 0.02, 0.7, 1, 0.65},
      {question.measurements[1].experiment, "restitution", true, 0.57, 0.01, 0.3, 0, 0.98}};
  result.predictions = {
      {0, 30.5 * degree, 0.2 * degree, 4, 0.4 * degree, 30.6 * degree, 0.3 * degree, -0.49},
      {1, 0.57, 0.001, 4, 0.002, 0.571, 0.003, -1.5}};
  result.offset = {0.5 * degree, 0.01};
  result.offset_error = {0.1 * degree, 0.002};
  result.misfit = 0.24;
  result.evaluations = 60;
  result.failed = 1;
  result.stop = calibrator::StopReason::hit;
  result.history = {{1, "start", result.best, {29.0 * degree, std::nan("")}, std::nan(""), 3.0},
                    {2, "confirm", result.best, {30.5 * degree, 0.57}, 0.24, 0.24}};
  result.remarks = {"Friction is not determined."};
  return result;
}

}  // namespace

TEST_CASE("a fit is printed in the units of the study", "[server]") {
  const Json json = Json::parse(print_fit(calibration(), fit()));
  CHECK(json["parameters"][0]["value"] == Approx(55));
  CHECK(json["parameters"][0]["unit"] == "%");
  CHECK(json["parameters"][1]["interval"][1] == Approx(10));
  CHECK(json["parameters"][1]["at_bound"]["upper"] == true);
  CHECK(json["measurements"][0]["measured"] == 31.0);
  CHECK(json["measurements"][0]["predicted"] == Approx(30.5));
  CHECK(json["measurements"][0]["difference"] == Approx(-0.5));
  CHECK(json["measurements"][0]["fidelity"] == "standard");
  CHECK(json["measurements"][1]["role"] == "held_out");
  CHECK(to_text(json["measurements"][1]["settings"]) ==
        R"({"height":{"value":300.0,"unit":"mm"}})");
  CHECK(json["directions"][0]["components"][1]["field"] == "material.shear_modulus");
  CHECK(json["history"][0]["misfit"].is_null());
  CHECK(json["history"][0]["observed"][1].is_null());
  CHECK(json["offset"][0]["value"] == Approx(0.5));
  CHECK(json["directions"][0]["components"][1]["power"] == -0.25);
  CHECK(json["directions"][0]["product_error"] == 0.06);
  CHECK(!json["directions"][1].contains("product_error"));
  CHECK(to_text(json["posterior"]["samples"][0]) == "[55.123,2.5]");
  CHECK(json["posterior"]["quantiles"][1][2] == Approx(9));
  CHECK(json["next_measurements"][0]["unit"] == "deg");
  CHECK(json["next_measurements"][0]["parameter"]["field"] == "material.shear_modulus");
  CHECK(to_text(json["next_measurements"][1]["settings"]) ==
        R"({"height":{"value":300.0,"unit":"mm"}})");
  CHECK(json["stop"] == "hit");
  CHECK(json["seed"] == 1);
  CHECK(json["engine_version"].is_string());
}

TEST_CASE("a fit reads back to the last digit or two", "[server]") {
  const std::string text = print_fit(calibration(), fit());
  const auto again = parse_fit(calibration(), text);
  if (!again) FAIL(again.error());
  CHECK(print_fit(calibration(), *again) == text);
  CHECK(again->best == fit().best);
  CHECK(again->parameters[1].upper == 1e7);
  CHECK(again->predictions[1].z == -1.5);
  CHECK(again->history[0].parameters.get(calibration().tied[0].key) == Approx(0.55));
  CHECK(std::isnan(again->history[0].values[1]));
  CHECK(again->stop == calibrator::StopReason::hit);
  CHECK(again->posterior.samples[1] == fit().posterior.samples[1]);
  CHECK(again->next[1].experiment.settings == fit().next[1].experiment.settings);
  CHECK(again->next[1].parameter == 0);
  CHECK(again->directions[0].powers == fit().directions[0].powers);
}

TEST_CASE("a fit of a program that drew no samples is read too", "[server]") {
  Json json = Json::parse(print_fit(calibration(), fit()));
  json.erase("posterior");
  json.erase("next_measurements");
  for (Json& direction : json["directions"]) {
    direction.erase("product_error");
    for (Json& component : direction["components"]) component.erase("power");
  }
  const auto read = parse_fit(calibration(), to_text(json));
  if (!read) FAIL(read.error());
  CHECK(read->posterior.samples.empty());
  CHECK(read->next.empty());
  CHECK(read->directions[0].powers.empty());
}

TEST_CASE("a fit without a single prediction can be printed and read", "[server]") {
  Fit empty;
  empty.stop = calibrator::StopReason::failed;
  empty.misfit = std::nan("");
  const auto again = parse_fit(calibration(), print_fit(calibration(), empty));
  REQUIRE(again);
  CHECK(again->stop == calibrator::StopReason::failed);
  CHECK(again->predictions.empty());
}

TEST_CASE("a text that is no fit is an error with a sentence", "[server]") {
  for (const char* text : {"", "{}", "[]", R"({"stop":"hit"})"}) {
    CHECK(!parse_fit(calibration(), text));
  }
}

TEST_CASE("progress has nulls before there is a misfit", "[server]") {
  calibrator::Progress progress;
  progress.stage = "start";
  progress.misfit = std::nan("");
  const Json json = Json::parse(print_progress(calibration(), progress));
  CHECK(json["misfit"].is_null());
  CHECK(json["predicted"].empty());
}

TEST_CASE("a calibration's document is read for those who show it", "[server]") {
  Json document{{"id", 7},
                {"name", "two free"},
                {"state", "done"},
                {"created_at", "2026-01-01T00:00:00Z"},
                {"started_at", nullptr},
                {"error", nullptr}};
  document["study"] = Json::parse(print_calibration(calibration()));
  document["fit"] = Json::parse(print_fit(calibration(), fit()));
  const auto read = repose::server::parse_document(to_text(document));
  if (!read) FAIL(read.error());
  CHECK(read->id == 7);
  CHECK(read->started_at.empty());
  CHECK(read->calibration == calibration());
  REQUIRE(read->fit);
  CHECK(read->fit->evaluations == 60);
  CHECK(!read->engine_version.empty());

  const auto items = repose::server::parse_items(to_text(Json{{"items", {document}}}));
  REQUIRE(items.size() == 1);
  CHECK(items[0].state == "done");
}
