// What the laboratory says of itself: pairs of fidelities, trends, explanations.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "engine/catalogue.hpp"
#include "server/cli/catalogue_text.hpp"
#include "server/cli/reference_grain.hpp"
#include "server/json/laboratory_json.hpp"
#include "server/json/replicates_json.hpp"
#include "server/json/text.hpp"
#include "server/laboratory/draft_bias.hpp"
#include "server/laboratory/drawings.hpp"
#include "server/laboratory/fidelity_pairs.hpp"
#include "server/laboratory/speed.hpp"
#include "server/laboratory/trends.hpp"
#include "server/report/trends_report.hpp"

using namespace repose;
using namespace repose::server;
using Catch::Contains;
using engine::make_key;
using enum engine::MaterialId;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Trends in which every observable is 2 for the reference grain and k at the k-th value.
Trends plain_trends() {
  Trends trends;
  trends.parameters = trend_parameters(reference_grain());
  for (const TrendParameter& parameter : trends.parameters) {
    Readings& readings = trends.readings.emplace_back();
    for (const auto& info : engine::experiment_catalogue()) {
      for (const auto& observable : info.observables) {
        const std::string name = std::string(info.name) + "." + std::string(observable.name);
        for (std::size_t k = 0; k < parameter.values.size(); ++k) {
          readings[name].push_back(static_cast<double>(k) * observable.unit.factor);
        }
        trends.reference[name] = {2.0 * observable.unit.factor, 2.1 * observable.unit.factor};
      }
    }
  }
  return trends;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
  return found;
}

}  // namespace

TEST_CASE("every observable tells how far its draft readings are from standard ones", "[server]") {
  for (const engine::ExperimentInfo& info : engine::experiment_catalogue()) {
    for (const engine::ObservableInfo& observable : info.observables) {
      INFO(info.name << "." << observable.name);
      CHECK(draft_bias(info, observable).sets >= 12);
      CHECK_FALSE(draft_words(info, observable).empty());
    }
  }
}

TEST_CASE("a draft whose settings are all given reads as standard does: its bias is not told",
          "[server]") {
  const engine::ExperimentInfo& kettle = *engine::find_experiment("kettle");
  engine::Experiment experiment{"kettle", engine::Fidelity::draft, {}};
  CHECK(draft_is_in_force(kettle, experiment));
  for (const engine::FieldInfo& field : kettle.settings) {
    if (!std::isnan(field.draft)) {
      CHECK(draft_is_in_force(kettle, experiment));
      experiment.settings[std::string(field.name)] = field.null_value;
    }
  }
  CHECK_FALSE(draft_is_in_force(kettle, experiment));
  CHECK_FALSE(draft_is_in_force(kettle, {"kettle", engine::Fidelity::standard, {}}));

  Replicates replicates;
  replicates.trial.experiment = experiment;
  replicates.evaluations.resize(1);
  replicates.evaluations[0].outcome = std::vector<engine::Observation>{{"bulk_density", 740.0}};
  replicates.wall_seconds = {1.0};
  CHECK_FALSE(Contains("draft_less_standard").match(print_replicates(replicates, "test")));
  replicates.trial.experiment.settings.clear();
  CHECK_THAT(print_replicates(replicates, "test"), Contains("draft_less_standard"));
}

TEST_CASE("the bias of a draft is over the grains that were read at both fidelities", "[server]") {
  FidelityPairs pairs;
  pairs.readings = {{3.0, 1.0}, {none, 1.0}, {5.0, 1.0}, {4.0, none}};
  const DraftBias bias = pairs.bias();
  CHECK(bias.sets == 2);
  CHECK(bias.mean == Approx(3.0));
  CHECK(bias.deviation == Approx(std::sqrt(2.0)));
  pairs.readings = {{none, 1.0}};
  CHECK(std::isnan(pairs.bias().mean));
}

TEST_CASE("the grains of the pairs fill the space: each slice of a parameter holds one",
          "[server]") {
  const auto grains = spread_grains(reference_grain(), 12);
  REQUIRE(grains.size() == 12);
  std::set<int> slices;
  for (const engine::ParameterSet& set : grains) {
    const double friction = *set.get(make_key("sliding_friction.coefficient", {grain, grain}));
    slices.insert(static_cast<int>((friction - 0.2) / 0.6 * 12.0));
    CHECK(*set.get(make_key("sliding_friction.coefficient", {grain, wall})) ==
          Approx(friction * 2.0 / 3.0));
  }
  CHECK(slices.size() == 12);
}

TEST_CASE("every effect that may be suspected has a trend that begins without it", "[server]") {
  const engine::ParameterSet reference = reference_grain();
  const auto parameters = trend_parameters(reference);
  for (const auto& effect : engine::effect_catalogue()) {
    if (effect.strong == nullptr) continue;
    CAPTURE(effect.text.name);
    const auto of_effect = [&](const TrendParameter& parameter) {
      return parameter.name.starts_with(std::string(effect.text.name) + ".");
    };
    CHECK(std::ranges::count_if(parameters, of_effect) == 1);
  }
  for (const TrendParameter& parameter : parameters) {
    CAPTURE(parameter.name);
    CHECK(parameter.values.front() != parameter.values.back());
    CHECK(parameter.grains.size() == parameter.values.size());
  }
}

TEST_CASE("the page of trends has a dot for every reading and a cross for every failure",
          "[server]") {
  Trends trends = plain_trends();
  const std::string whole = print_trends_report(trends, "repose trends");
  std::size_t readings = 0;
  for (const Readings& of_parameter : trends.readings) {
    for (const auto& [name, values] : of_parameter) readings += values.size();
  }
  CHECK(count(whole, "<circle") == readings);
  CHECK(count(whole, ">×<") == 0);
  CHECK(count(whole, "<script") == 0);
  trends.readings[0]["kettle.bulk_density"][1] = none;
  const std::string broken = print_trends_report(trends, "repose trends");
  CHECK(count(broken, "<circle") == readings - 1);
  CHECK(count(broken, ">×<") == 1);
}

TEST_CASE("a reading that failed is null in the trends' document", "[server]") {
  Trends trends = plain_trends();
  trends.readings[0]["drum.dynamic_angle"][1] = none;
  const Json document = Json::parse(print_trends(trends));
  const Json& angles = document.at("parameters").at(0).at("readings").at("drum.dynamic_angle");
  CHECK(angles.at(0) == 0.0);
  CHECK(angles.at(1).is_null());
  CHECK(angles.at(2).get<double>() == Approx(2.0));  // deg
}

TEST_CASE("the costs of all experiments are summed by fidelity", "[server]") {
  const ExperimentCost all = sum({{"a", {1.0, 10.0}, {5.0, 6.0}}, {"b", {2.0, 20.0}, {7.0, 8.0}}});
  CHECK(all.seconds[0] == 3.0);
  CHECK(all.seconds[1] == 30.0);
  CHECK(all.grain_steps[1] == 14.0);
}

TEST_CASE("an explanation names every setting and observable, and fits a terminal's width",
          "[server]") {
  for (const auto& info : engine::experiment_catalogue()) {
    CAPTURE(info.name);
    const std::string text = explanation(info);
    for (const auto& setting : info.settings) CHECK_THAT(text, Contains(std::string(setting.name)));
    for (const auto& seen : info.observables) CHECK_THAT(text, Contains(std::string(seen.name)));
    CHECK(std::ranges::count(text, '\n') < 60);
  }
}

TEST_CASE("every experiment is drawn in letters that a terminal shows", "[server]") {
  for (const auto& info : engine::experiment_catalogue()) {
    CAPTURE(info.name);
    const std::string_view drawing = drawing_of(info.name);
    CHECK(std::ranges::count(drawing, '\n') > 5);
    std::size_t width = 0;
    for (const char c : drawing) {
      CHECK((c == '\n' || (c >= ' ' && c <= '~')));
      width = c == '\n' ? 0 : width + 1;
      CHECK(width <= 88);
    }
  }
}
