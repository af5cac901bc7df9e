#include "calibrator/ledger.hpp"

#include <cmath>
#include <set>

#include <catch2/catch.hpp>

#include "tests/support/known_ledger.hpp"
#include "tests/support/toy_study.hpp"

using namespace repose;
using namespace repose::calibrator;

namespace {

toy::Study line() {
  toy::Study study;
  study.response = [](std::span<const double> u) { return std::vector<double>{u[0], 2.0 * u[0]}; };
  study.sigma = {0.1, 0.1};
  study.truth = {0.5};
  return toy::ask(std::move(study), 1, 40, 4);
}

}  // namespace

TEST_CASE("a batch is asked in one call, and every run of a site has its own seed",
          "[calibrator]") {
  const toy::Study study = line();
  int calls = 0;
  std::set<std::uint64_t> seeds;
  const Evaluator evaluator = [&](std::span<const engine::Trial> trials) {
    ++calls;
    std::vector<engine::Evaluation> answers;
    for (const engine::Trial& trial : trials) {
      seeds.insert(trial.seed);
      answers.push_back(toy::answer(study, trial));
    }
    return answers;
  };
  Ledger ledger(study.calibration, evaluator);
  const std::size_t a = ledger.site_at({0.2});
  const std::size_t b = ledger.site_at({0.7});
  CHECK(ledger.site_at({0.2}) == a);
  ledger.run("start",
             std::vector<Ledger::Request>{
                 {a, 0, Level::search}, {a, 1, Level::search}, {b, 0, Level::search}});
  CHECK(calls == 1);
  CHECK(seeds.size() == 3);
  CHECK(ledger.spent() == 3);
  CHECK(ledger.remaining() == 37);
  CHECK(ledger.fresh_replicate(a) == 2);
  CHECK(ledger.history().size() == 3);
  CHECK(ledger.history()[2].evaluation == 3);
  CHECK(ledger.history()[2].stage == "start");
}

TEST_CASE("the same replicate of a site has one seed at both fidelities", "[calibrator]") {
  toy::Study study = line();
  study.calibration.budget.fidelity = engine::Fidelity::draft;
  std::vector<engine::Trial> asked;
  const Evaluator evaluator = [&](std::span<const engine::Trial> trials) {
    asked.insert(asked.end(), trials.begin(), trials.end());
    return toy::evaluator(study)(trials);
  };
  Ledger ledger(study.calibration, evaluator);
  const std::size_t a = ledger.site_at({0.2});
  ledger.run("pair", std::vector<Ledger::Request>{{a, 3, Level::search}, {a, 3, Level::confirm}});
  REQUIRE(asked.size() == 2);
  CHECK(asked[0].seed == asked[1].seed);
  CHECK(asked[0].experiment.fidelity == engine::Fidelity::draft);
  CHECK(asked[1].experiment.fidelity == engine::Fidelity::standard);
  CHECK(ledger.sites()[a].searched.size() == 1);
  CHECK(ledger.sites()[a].confirmed.size() == 1);
}

TEST_CASE("scatter is pooled over sites, each about its own mean", "[calibrator]") {
  toy::Study study = line();
  const std::vector<double> noise{-0.1, 0.1, -0.3, 0.3};  // squares about the means: 0.02 and 0.18
  std::size_t next = 0;
  const Evaluator evaluator = [&](std::span<const engine::Trial> trials) {
    std::vector<engine::Evaluation> answers;
    for (const engine::Trial& trial : trials) {
      const double u = SearchSpace(study.calibration).coordinates(trial.parameters)[0];
      std::vector<engine::Observation> seen{{"y0", u + noise[next++]}, {"y1", 1.0}};
      answers.push_back({trial, std::move(seen), {}});
    }
    return answers;
  };
  Ledger ledger(study.calibration, evaluator);
  CHECK(ledger.scatter(Level::search).variance[0] == Approx(0.01));  // nothing known: sigma^2
  const std::size_t a = ledger.site_at({0.0});
  const std::size_t b = ledger.site_at({1.0});
  for (const std::size_t site : {a, b}) {
    ledger.run("start",
               std::vector<Ledger::Request>{{site, 0, Level::search}, {site, 1, Level::search}});
  }
  const Scatter scatter = ledger.scatter(Level::search);
  CHECK(scatter.variance[0] == Approx((0.02 + 0.18) / 2.0));
  CHECK(scatter.freedom[0] == 2);
  CHECK(scatter.variance[1] == Approx(1e-4 * 0.01));  // the floor: a hundredth of sigma
}

TEST_CASE("a site's own scatter counts for more the more runs it has", "[calibrator]") {
  // (nu0 s2 + SS) / (nu0 + R - 1) with nu0 = 4, worked out by hand.
  CHECK(run_variance({0.0, 0.0, 1}, 1.0) == Approx(1.0));
  CHECK(run_variance({0.0, 20.0, 5}, 1.0) == Approx((4.0 + 20.0) / 8.0));
}

TEST_CASE("failures are counted by kind, and the commonest is quoted", "[calibrator]") {
  toy::Study study = line();
  study.fails = [](auto u) { return u[0] > 0.5; };
  const Evaluator evaluator = toy::evaluator(study);
  Ledger ledger(study.calibration, evaluator);
  const std::size_t good = ledger.site_at({0.2});
  const std::size_t bad = ledger.site_at({0.9});
  const auto runs = ledger.run(
      "start", std::vector<Ledger::Request>{{good, 0, Level::search}, {bad, 0, Level::search}});
  CHECK(runs[0].succeeded);
  CHECK_FALSE(runs[1].succeeded);
  CHECK(std::isnan(ledger.history()[1].misfit));
  CHECK(ledger.failed() == 1);
  CHECK(ledger.commonest_failure() == "toy: did_not_rest (the heap still creeps)");
}

TEST_CASE("of many known runs the closest to the targets are kept, in their order",
          "[calibrator]") {
  const toy::Study study = toy::two_of_three(0.3);
  std::vector<KnownRun> known;
  const double y0 = study.calibration.measurements[0].value;
  const double y1 = study.calibration.measurements[1].value;
  for (const double off : {3.0, 0.5, 2.0, 0.1, std::nan("")}) {
    known.push_back({{}, Level::search, {y0 + off, y1}, off});
  }
  const auto closest = closest_runs(study.calibration, known, 3);
  REQUIRE(closest.size() == 3);
  CHECK(closest[0].grain_steps == 0.5);
  CHECK(closest[1].grain_steps == 2.0);
  CHECK(closest[2].grain_steps == 0.1);
  CHECK(closest_runs(study.calibration, known, 9).size() == 5);
}
