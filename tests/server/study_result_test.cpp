#include "server/studies/study_result.hpp"

#include <cmath>
#include <fstream>
#include <sstream>

#include <catch2/catch.hpp>

#include "server/json/study_result_json.hpp"
#include "server/studies/study_findings.hpp"
#include "server/studies/study_runner.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace repose;
using namespace repose::server;
using repose::tests::TemporaryFolder;

namespace {

std::string read(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// A study of drop tests alone, with two levels of restitution.
PublishedStudy small_study() {
  PublishedStudy study;
  study.name = "small";
  study.base = "1";
  study.best = "2";
  study.experiments = {{"drop", "restitution", "1", 0.5, 4, 2}};
  study.drop_experiment = "drop";
  study.drop_observable = "restitution";
  study.drop_accuracy = {{0.8, 0.1, 0.2}};
  study.common = {"material.density:grain=1228 kg/m3",
                  "material.diameter:grain=6.5 mm",
                  "material.shear_modulus:grain=10 MPa",
                  "material.poisson_ratio:grain=0.25",
                  "material.shear_modulus:wall=10 MPa",
                  "material.poisson_ratio:wall=0.25"};
  study.factors = {{"restitution", "1", {"restitution.coefficient:grain-wall"}, {{0.4}, {0.8}}}};
  study.runs = {{"1", {{"drop", {0.40, 0.02}}}}, {"2", {{"drop", {0.79, 0.02}}}}};
  study.tables = {{"Table 1", "restitution", {{"base", {"1"}}, {"restitution", {"2"}}}}};
  study.computing_hours = {{"1", {{"drop", {2.0, 0.0}}}}, {"2", {{"drop", {3.0, 0.0}}}}};
  study.variants = {{"bouncy",
                     "restitution",
                     "high restitution",
                     {"drop"},
                     {"restitution.coefficient:grain-wall=0.6"},
                     {}}};
  study.search = read(REPOSE_SOURCE_DIR "/schemas/examples/valid/drop-minimal.json");
  study.quick_search_evaluations = 8;
  return study;
}

Sample sample(std::vector<double> values, double grain_steps = 0.0, double seconds = 0.0) {
  Sample result;
  result.values = std::move(values);
  result.grain_steps = grain_steps;
  result.simulated_seconds = seconds;
  return result;
}

}  // namespace

TEST_CASE("a sample's spread is that of its values about their mean", "[server]") {
  const Sample three = sample({1.0, 2.0, 6.0});
  CHECK(three.mean() == 3.0);
  CHECK(three.deviation() == Approx(std::sqrt(7.0)));
  CHECK(three.error() == Approx(std::sqrt(7.0 / 3.0)));
  CHECK(std::isnan(sample({1.0}).deviation()));
  CHECK(std::isnan(sample({}).mean()));
}

TEST_CASE("a trend agrees where the change has the paper's sign, clearly where both exceed errors",
          "[server]") {
  const PublishedStudy study = small_study();
  StudyResult result;
  result.study = &study;
  const auto trend_of = [&](std::vector<double> base, std::vector<double> run) {
    result.runs["1"]["drop"] = sample(std::move(base));
    result.runs["2"]["drop"] = sample(std::move(run));
    return trend(result, "2", study.experiments[0]);
  };
  const Trend up = trend_of({0.40, 0.42}, {0.70, 0.72});
  CHECK(up.paper == Approx(0.39));
  CHECK(up.ours == Approx(0.30));
  CHECK(up.agrees == true);
  CHECK(up.clear());
  const Trend faint = trend_of({0.3, 0.5}, {0.4, 0.5});
  CHECK(faint.agrees == true);
  CHECK(faint.paper_clear);
  CHECK_FALSE(faint.clear());
  const Trend down = trend_of({0.40, 0.42}, {0.30, 0.32});
  CHECK(down.agrees == false);
  const TrendCount count = count_trends(result, study.tables[0], study.experiments[0]);
  CHECK(count.opposite == 1);
  CHECK(count.clearly_opposite == std::vector<std::string>{"2"});
  CHECK(count.agree == 0);
  CHECK_FALSE(trend_of({0.4, 0.5}, {}).agrees.has_value());
  CHECK_FALSE(trend(result, "1", study.experiments[0]).agrees.has_value());
}

TEST_CASE("the cost of a run is its steps for a simulated second over the base's", "[server]") {
  const PublishedStudy study = small_study();
  StudyResult result;
  result.study = &study;
  result.runs["1"]["drop"] = sample({0.4}, 1000.0, 2.0);
  result.runs["2"]["drop"] = sample({0.8}, 1000.0, 0.5);
  const CostRatio ratio = cost_ratio(result, "2", "drop");
  CHECK(ratio.paper == Approx(1.5));
  CHECK(ratio.ours == Approx(4.0));
}

TEST_CASE("a variant explains the share of the gap that it closes", "[server]") {
  const PublishedStudy study = small_study();
  StudyResult result;
  result.study = &study;
  result.runs["1"]["drop"] = sample({0.59, 0.61});
  result.variants = {{"bouncy", {{"drop", sample({0.54, 0.56})}}}};
  const auto explained = explain(result, "bouncy", study.experiments[0]);
  REQUIRE(explained.has_value());
  CHECK(explained->change == Approx(-0.05));
  CHECK(explained->share == Approx(0.25));
  CHECK(explained->left == Approx(0.15));
  CHECK(explained->error == Approx(std::sqrt(2.0) * 0.01));
  CHECK_FALSE(explain(result, "none", study.experiments[0]).has_value());
}

TEST_CASE("the findings name what explains most of the gap first, and what is within its scatter",
          "[server]") {
  PublishedStudy study = small_study();
  study.variants.push_back(study.variants[0]);
  study.variants[1].variant = "heavy";
  study.variants[1].kind = "weight";
  StudyResult result;
  result.study = &study;
  result.runs["1"]["drop"] = sample({0.79, 0.81});  // the paper has 0.40
  result.variants = {{"bouncy", {{"drop", sample({0.74, 0.86})}}},
                     {"heavy", {{"drop", sample({0.59, 0.61})}}}};
  std::string all;
  for (const std::string& sentence : findings(result)) all += sentence + "\n";
  CHECK_THAT(all,
             Catch::Contains("weight (heavy) 50 %; restitution (bouncy) 0 %, within its scatter"));
}

TEST_CASE("a study runs what is cheap first", "[server]") {
  const PublishedStudy study = small_study();
  const engine::ParameterSet base = run_parameters(study, "1");
  const auto with = [&](std::string_view field, double value) {
    engine::ParameterSet set = base;
    set.set(engine::make_key(field, {engine::MaterialId::grain}), value);
    return expected_cost(set) / expected_cost(base);
  };
  CHECK(with("material.shear_modulus", 40e6) == Approx(2.0));
  CHECK(with("grain_shape.members", 3.0) == Approx(3.0));
  CHECK(with("size_spread.deviation", 0.4) == Approx(1.0 / std::cbrt(0.2)));
}

TEST_CASE("a study asked for again is answered from the store, the same to the letter",
          "[server]") {
  const TemporaryFolder folder;
  const PublishedStudy study = small_study();
  db::Store store(folder / "a.db", db::Access::write);
  Workers workers(store, {.workers = 2});
  std::size_t ran = 0;
  const StudyObserver count = [&](std::string_view, std::size_t, std::size_t, bool stored) {
    ran += stored ? 0 : 1;
  };
  const StudyResult first = run_study(study, StudySize::quick, workers, {}, count);
  CHECK(ran > 4);
  CHECK(first.sample("2", "drop").mean() == Approx(0.8).margin(0.01));
  REQUIRE(first.search.has_value());
  CHECK(first.missing == 0);
  CHECK(first.search->samples.at("drop").values.size() == 2);
  ran = 0;
  const StudyResult second = run_study(study, StudySize::quick, workers, {}, count);
  CHECK(ran == 0);
  CHECK(print_study_result(first) == print_study_result(second));
}

TEST_CASE("a study that is asked to stop gives what it has and says what is missing", "[server]") {
  const TemporaryFolder folder;
  const PublishedStudy study = small_study();
  db::Store store(folder / "a.db", db::Access::write);
  Workers workers(store, {.workers = 1});
  std::stop_source stop;
  const StudyObserver stop_after_two = [&](std::string_view, std::size_t done, std::size_t, bool) {
    if (done == 2) stop.request_stop();
  };
  const StudyResult part =
      run_study(study, StudySize::quick, workers, stop.get_token(), stop_after_two);
  CHECK(part.missing > 0);
  CHECK(part.missing < part.trials);
  CHECK(part.sample("1", "drop").mean() == Approx(0.4).margin(0.01));
  CHECK(part.variants.at(0).samples.at("drop").failed == 0);
  CHECK_FALSE(part.search.has_value());
  CHECK_THAT(findings(part).front(), Catch::Contains("Unfinished"));
  const StudyResult whole = run_study(study, StudySize::quick, workers, {}, {});
  CHECK(whole.missing == 0);
}
