#include "calibrator/calibrate.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "calibrator/misfit.hpp"
#include "calibrator/plan.hpp"
#include "tests/support/bench_run.hpp"
#include "tests/support/known_ledger.hpp"
#include "tests/support/toy_study.hpp"

using namespace repose;
using namespace repose::calibrator;

namespace {

Fit solve(const toy::Study& study) { return calibrate(study.calibration, toy::evaluator(study)); }

bool mentions(const Fit& fit, const std::string& words) {
  return std::ranges::any_of(fit.remarks, [&](const std::string& remark) {
    return remark.find(words) != std::string::npos;
  });
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void check_equal(const Fit& a, const Fit& b) {
  CHECK(a.best == b.best);
  CHECK(a.stop == b.stop);
  CHECK(same_bits(a.misfit, b.misfit));
  CHECK(a.remarks == b.remarks);
  REQUIRE(a.parameters.size() == b.parameters.size());
  for (std::size_t k = 0; k < a.parameters.size(); ++k) {
    CHECK(same_bits(a.parameters[k].value, b.parameters[k].value));
    CHECK(same_bits(a.parameters[k].lower, b.parameters[k].lower));
    CHECK(same_bits(a.parameters[k].upper, b.parameters[k].upper));
    CHECK(same_bits(a.parameters[k].learnt, b.parameters[k].learnt));
  }
  REQUIRE(a.history.size() == b.history.size());
  for (std::size_t i = 0; i < a.history.size(); ++i) {
    CHECK(a.history[i].parameters == b.history[i].parameters);
    CHECK(same_bits(a.history[i].best, b.history[i].best));
  }
}

/// Asserts what holds of every fit that came to an end.
void check_complete(const toy::Study& study, const Fit& fit) {
  const Calibration& c = study.calibration;
  CHECK(fit.evaluations <= c.budget.evaluations);
  CHECK(fit.evaluations == static_cast<int>(fit.history.size()));
  CHECK(fit.parameters.size() == c.free.size());
  CHECK(fit.predictions.size() == c.measurements.size());
  CHECK(fit.offset.size() == c.measurements.size());
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    const FittedParameter& p = fit.parameters[k];
    CHECK(p.lower <= p.value);
    CHECK(p.value <= p.upper);
    CHECK(p.lower >= c.free[k].lower);
    CHECK(p.upper <= c.free[k].upper);
  }
}

}  // namespace

TEST_CASE("a budget that leaves nothing to search with is told, and how much would",
          "[calibrator]") {
  toy::Study study = toy::two_of_three(0.3);
  study.calibration.measurements[0].value += 100.0;  // out of reach: the start is no hit
  Budget& budget = study.calibration.budget;
  const auto searched = [](const Fit& fit) {
    return std::ranges::count(fit.history, "search", &HistoryPoint::stage) > 0;
  };
  const int full = searching_budget(study.calibration);
  const auto more = std::to_string(budget.batch) + " more evaluations";
  budget.evaluations = full - budget.batch;
  const Fit unsearched = solve(study);
  REQUIRE(unsearched.stop == StopReason::budget);
  REQUIRE_FALSE(searched(unsearched));
  CHECK(mentions(unsearched, "No search took place"));
  CHECK(mentions(unsearched, more));
  budget.evaluations = full;
  const Fit fit = solve(study);
  CHECK(searched(fit));
  CHECK_FALSE(mentions(fit, "No search took place"));
}

TEST_CASE("a measurement that stands twice in a study is named", "[calibrator]") {
  toy::Study study = toy::two_of_three(0.3);
  CHECK_FALSE(mentions(solve(study), "count twice"));
  auto& measurements = study.calibration.measurements;
  measurements.push_back(measurements.front());
  const std::string words = "Measurements 1 and " + std::to_string(measurements.size());
  CHECK(mentions(solve(study), words));
  measurements.back().value += 0.01;  // another reading of it
  CHECK_FALSE(mentions(solve(study), "count twice"));
  measurements.back() = measurements.front();
  measurements.back().role = Role::held_out;
  CHECK_FALSE(mentions(solve(study), "count twice"));
}

TEST_CASE("a known minimum is recovered and confirmed", "[calibrator]") {
  const toy::Study study = toy::two_of_three(0.3);
  const Fit fit = solve(study);
  check_complete(study, fit);
  CHECK(fit.stop == StopReason::hit);
  // A hit is within one sigma (0.5) of each target, and the slope is 10.
  CHECK(fit.parameters[0].value == Approx(0.4).margin(0.05));
  CHECK(fit.parameters[1].value == Approx(0.6).margin(0.05));
  CHECK(fit.parameters[0].determined);
  CHECK(fit.predictions[0].replicates >= 4);
  CHECK(fit.misfit < 2.0);  // each |z| is below one
}

TEST_CASE("a parameter that the data ignore is reported as not determined", "[calibrator]") {
  const Fit fit = solve(toy::two_of_three(0.3));
  CHECK_FALSE(fit.parameters[2].determined);
  CHECK(fit.parameters[2].lower_at_bound);
  CHECK(fit.parameters[2].upper_at_bound);
  CHECK(mentions(fit, "The data determine 2 of 3 directions; toy.u2 is not determined"));
  CHECK(
      mentions(fit, "With 2 fitted measurements for 3 free parameters the model cannot be tested"));
}

TEST_CASE("equal questions give equal bits, another seed gives others", "[calibrator]") {
  const toy::Study study = toy::two_of_three(0.5);
  const Fit fit = solve(study);
  check_equal(fit, solve(study));
  CHECK(fit.best != solve(toy::two_of_three(0.5, 2)).best);
}

TEST_CASE("a replay that answers from what was stored gives the same fit", "[calibrator]") {
  const toy::Study study = toy::two_of_three(0.5);
  using Question = std::pair<std::map<engine::ParameterKey, double>, std::uint64_t>;
  std::map<Question, engine::Evaluation> store;
  int simulated = 0;
  const Evaluator cached = [&](std::span<const engine::Trial> trials) {
    std::vector<engine::Evaluation> answers;
    for (const engine::Trial& trial : trials) {
      const Question question{{trial.parameters.begin(), trial.parameters.end()}, trial.seed};
      const auto [entry, is_new] = store.try_emplace(question);
      if (is_new) {
        ++simulated;
        entry->second = toy::answer(study, trial);
      }
      answers.push_back(entry->second);
    }
    return answers;
  };
  const Fit first = calibrate(study.calibration, cached);
  const int needed = simulated;
  CHECK(needed == first.evaluations);  // no question was asked twice
  const Fit again = calibrate(study.calibration, cached);
  CHECK(simulated == needed);
  check_equal(first, again);
}

TEST_CASE("the budget is never exceeded, however small", "[calibrator][slow]") {
  for (const int evaluations : {0, 5, 8, 9, 10, 12, 15, 17, 23, 31}) {
    for (const auto fidelity : {engine::Fidelity::draft, engine::Fidelity::standard}) {
      toy::Study study = toy::two_of_three(1.5);
      study.calibration.budget.evaluations = evaluations;
      study.calibration.budget.fidelity = fidelity;
      int asked = 0;
      const Fit fit = calibrate(study.calibration, [&](std::span<const engine::Trial> trials) {
        asked += static_cast<int>(trials.size());
        return toy::evaluator(study)(trials);
      });
      INFO("budget " << evaluations);
      CHECK(asked <= evaluations);
      CHECK(fit.evaluations == asked);
      if (fit.stop == StopReason::failed) {
        CHECK(mentions(fit, "is too small"));
        CHECK(asked == 0);
      } else {
        check_complete(study, fit);
        CHECK(fit.predictions[0].replicates >= 2);
      }
    }
  }
}

TEST_CASE("a region that fails is avoided and counted", "[calibrator]") {
  toy::Study study = toy::two_of_three(0.3);
  study.fails = [](std::span<const double> u) { return u[2] > 0.6; };
  const Fit fit = solve(study);
  check_complete(study, fit);
  CHECK(fit.stop == StopReason::hit);
  CHECK(fit.failed > 0);
  CHECK(fit.parameters[2].value <= 0.6);
  CHECK(mentions(fit, "did_not_rest (the heap still creeps)"));
  // 40 % of the cube fails. Of what the search proposed, less than that did.
  int proposed = 0;
  int failed = 0;
  for (const HistoryPoint& point : fit.history) {
    if (point.stage != "search") continue;
    ++proposed;
    if (std::isnan(point.misfit)) ++failed;
  }
  CHECK(failed * 10 <= proposed * 4);
}

TEST_CASE("when nearly everything fails the commonest failure is quoted", "[calibrator]") {
  toy::Study study = toy::two_of_three(0.3);
  study.fails = [](std::span<const double> u) { return u[0] > 0.02; };
  const Fit fit = solve(study);
  CHECK(fit.stop == StopReason::failed);
  CHECK(mentions(fit, "did_not_rest (the heap still creeps)"));
  CHECK(fit.evaluations <= study.calibration.budget.evaluations);
}

TEST_CASE("a held-out measurement is predicted but not fitted", "[calibrator]") {
  toy::Study study = toy::two_of_three(0.3);
  study.response = [](std::span<const double> u) {
    return std::vector<double>{10.0 * u[0], 10.0 * u[1], 10.0 * u[0] + 10.0 * u[1]};
  };
  study.sigma = {0.5, 0.5, 0.5};
  study.calibration = {};
  study = toy::ask(std::move(study), 1, 60, 4);
  study.calibration.measurements[2].role = Role::held_out;
  const Fit right = solve(study);
  // Its value does not move the fit by a bit, but the report says that it is off.
  study.calibration.measurements[2].value += 50.0;
  const Fit wrong = solve(study);
  CHECK(right.best == wrong.best);
  CHECK(right.stop == StopReason::hit);
  CHECK(right.predictions[2].predicted == Approx(10.0).margin(1.5));  // both sums off by a sigma
  CHECK(std::abs(right.predictions[2].z) < 2.0);
  CHECK(wrong.predictions[2].z < -10.0);
  CHECK(mentions(wrong, "The held-out toy y2 is not predicted"));
  CHECK_FALSE(mentions(right, "held-out"));
}

TEST_CASE("the bias of a cheap fidelity is learnt and taken off", "[calibrator]") {
  toy::Study study = toy::two_of_three(0.3);
  study.draft_bias = [](auto) { return std::vector<double>{2.0, -1.0}; };
  study.calibration.budget.fidelity = engine::Fidelity::draft;
  const Fit fit = solve(study);
  check_complete(study, fit);
  CHECK(fit.stop == StopReason::hit);
  // Scatter of a run is 0.15; the error learnt says how well the offset must be known.
  for (std::size_t j = 0; j < 2; ++j) {
    const double truth = j == 0 ? -2.0 : 1.0;
    CHECK(fit.offset_error[j] < 0.3);
    CHECK(std::abs(fit.offset[j] - truth) < 4.0 * fit.offset_error[j]);
  }
  // Without the offset the parameters would be off by 0.2 and 0.1.
  CHECK(fit.parameters[0].value == Approx(0.4).margin(0.05));
  CHECK(fit.parameters[1].value == Approx(0.6).margin(0.05));
  std::set<std::string> stages;
  for (const HistoryPoint& point : fit.history) stages.emplace(point.stage);
  CHECK(stages.contains("pair"));
  CHECK(stages.contains("confirm"));
}

TEST_CASE("a target out of the model's reach is called implausible", "[calibrator]") {
  toy::Study study = toy::two_of_three(0.3);
  study.calibration.measurements[0].value = 15.0;  // y0 reaches 10.1, sigma 0.5
  const Fit fit = solve(study);
  check_complete(study, fit);
  CHECK(fit.stop == StopReason::implausible);
  CHECK(mentions(fit, "physics is missing"));
  CHECK(fit.parameters[0].value > 0.9);  // as near as it gets
}

TEST_CASE("two targets that contradict each other end the search early", "[calibrator]") {
  toy::Study study = toy::two_of_three(0.3);
  study.response = [](std::span<const double> u) {
    return std::vector<double>{10.0 * u[0], 10.0 * u[0]};
  };
  study.calibration = {};
  study = toy::ask(std::move(study), 1, 60, 4);
  study.calibration.measurements[1].value += 2.0;  // four sigma apart: two sigma each at best
  const Fit fit = solve(study);
  check_complete(study, fit);
  CHECK(fit.stop == StopReason::no_better);
  CHECK(fit.evaluations < 60);
  CHECK(fit.parameters[0].value == Approx(0.5).margin(0.05));
}

TEST_CASE("a set that fresh runs belie is not the answer where another was confirmed better",
          "[calibrator][slow]") {
  int twice = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const toy::Study study = toy::eight_by_eight(seed, 36, 4);
    const Fit fit = solve(study);
    check_complete(study, fit);
    // Misfits of the means of each set's confirming runs, against the errors of the targets.
    std::vector<std::pair<engine::ParameterSet, std::vector<std::vector<double>>>> sets;
    for (const HistoryPoint& point : fit.history) {
      if (point.stage != "confirm") continue;
      auto found = std::ranges::find(sets, point.parameters, [](const auto& s) { return s.first; });
      if (found == sets.end()) found = sets.insert(found, {point.parameters, {}});
      found->second.push_back(point.values);
    }
    REQUIRE_FALSE(sets.empty());
    if (sets.size() > 1) ++twice;
    const auto misfit_of = [&](const auto& set) {
      double sum = 0.0;
      for (std::size_t j = 0; j < study.sigma.size(); ++j) {
        double mean = 0.0;
        for (const auto& values : set.second) {
          mean += values[j] / static_cast<double>(set.second.size());
        }
        const double z = (mean - study.calibration.measurements[j].value) / study.sigma[j];
        sum += z * z;
      }
      return sum;
    };
    const auto told = std::ranges::find(sets, fit.best, [](const auto& s) { return s.first; });
    REQUIRE(told != sets.end());
    for (const auto& set : sets) CHECK(misfit_of(*told) < 1.5 * misfit_of(set) + 1.0);
  }
  CHECK(twice > 0);
}

TEST_CASE("fresh runs that rule a hit out are not repeated", "[calibrator]") {
  toy::Study study = toy::two_of_three(1.5);       // eight would confirm
  study.calibration.measurements[0].value = 30.0;  // y0 reaches 10.1
  const Fit fit = solve(study);
  CHECK(fit.stop == StopReason::implausible);
  CHECK(std::ranges::count(fit.history, std::string_view("confirm"), &HistoryPoint::stage) == 4);
}

TEST_CASE("simulations noisier than the measurement are named", "[calibrator]") {
  toy::Study study = toy::two_of_three(3.0);
  study.calibration.budget.evaluations = 30;
  const Fit fit = solve(study);
  CHECK(mentions(fit, "One run of toy y0 scatters by"));
  CHECK(mentions(fit, "more than the measurement's standard error of 0.5"));
}

TEST_CASE("a cancelled calibration returns what it knows", "[calibrator]") {
  const toy::Study study = toy::two_of_three(0.5);
  std::stop_source source;
  int calls = 0;
  const Fit fit = calibrate(study.calibration,
                            [&](std::span<const engine::Trial> trials) {
                              if (++calls == 2) source.request_stop();
                              return toy::evaluator(study)(trials);
                            },
                            {.stop = source.get_token()});
  CHECK(fit.stop == StopReason::cancelled);
  CHECK(calls == 2);
  CHECK(fit.parameters.size() == 3);
  CHECK(fit.predictions[0].replicates == 0);

  source = {};
  source.request_stop();
  const Fit nothing =
      calibrate(study.calibration, toy::evaluator(study), {.stop = source.get_token()});
  CHECK(nothing.stop == StopReason::cancelled);
  CHECK(nothing.evaluations == 0);
}

TEST_CASE("what the evaluator throws comes out of calibrate", "[calibrator]") {
  const toy::Study study = toy::two_of_three(0.5);
  const Evaluator broken = [](std::span<const engine::Trial>) -> std::vector<engine::Evaluation> {
    throw std::runtime_error("the store is gone");
  };
  CHECK_THROWS_WITH(calibrate(study.calibration, broken), "the store is gone");
}

TEST_CASE("one free parameter and none are calibrations too", "[calibrator]") {
  toy::Study study;
  study.response = [](std::span<const double> u) {
    return std::vector<double>{u.empty() ? 3.0 : std::exp(2.0 * u[0])};
  };
  study.sigma = {0.1};
  study.noise = 0.3;
  study.truth = {0.7};
  const toy::Study one = toy::ask(study, 1, 40, 4);
  const Fit fit = solve(one);
  check_complete(one, fit);
  CHECK(fit.stop == StopReason::hit);
  CHECK(fit.parameters[0].value == Approx(0.7).margin(0.02));  // slope 8, sigma 0.1

  study.truth = {};
  const toy::Study none = toy::ask(study, 1, 40, 4);
  const Fit fixed = solve(none);
  check_complete(none, fixed);
  CHECK(fixed.stop == StopReason::hit);
}

TEST_CASE("progress is told after every batch, and ends with the best set", "[calibrator]") {
  const toy::Study study = toy::two_of_three(0.5);
  std::vector<Progress> told;
  const Fit fit = calibrate(study.calibration,
                            toy::evaluator(study),
                            {.observer = [&](const Progress& p) { told.push_back(p); }});
  REQUIRE(told.size() >= 4);
  CHECK(told.front().stage == "start");
  CHECK(std::isnan(told.front().misfit));
  CHECK(told.back().evaluations_done == fit.evaluations);
  CHECK(told.back().evaluations_planned == 60);
  CHECK(told.back().predicted.size() == 2);
  CHECK(std::ranges::is_sorted(told, {}, &Progress::evaluations_done));
}

TEST_CASE("no run is asked for, and no set recommended, that breaks a constraint", "[calibrator]") {
  toy::Study study = toy::two_of_three(0.3);
  const auto& free = study.calibration.free;
  // The truth (0.4, 0.6) is cut off; by symmetry the nearest is (0.35, 0.55), one sigma from both.
  study.calibration.constraints.push_back({{{free[0].key, 1.0}, {free[1].key, 1.0}}, 0.9, {}});
  const Fit fit = solve(study);
  check_complete(study, fit);
  for (const HistoryPoint& point : fit.history) {
    CHECK(point.parameters.get_or(free[0].key, 9.0) + point.parameters.get_or(free[1].key, 9.0) <=
          0.9);
  }
  CHECK(fit.parameters[0].value == Approx(0.35).margin(0.05));
  CHECK(fit.parameters[1].value == Approx(0.55).margin(0.05));
  CHECK(fit.parameters[0].value + fit.parameters[1].value > 0.88);  // up against it
}

TEST_CASE("what earlier runs know beyond a constraint is evidence, and no answer", "[calibrator]") {
  toy::Study study = toy::two_of_three(0.3);
  const Fit before = solve(study);
  std::vector<KnownRun> known;
  for (const HistoryPoint& point : before.history) {
    known.push_back({point.parameters, Level::search, point.values, 1.0});
  }
  const auto& free = study.calibration.free;
  study.calibration.constraints.push_back({{{free[0].key, 1.0}}, 0.38, {}});  // the truth is at 0.4
  const Fit fit = calibrate(study.calibration, toy::evaluator(study), {.known = known});
  CHECK(fit.best.get_or(free[0].key, 9.0) <= 0.38);
  for (const HistoryPoint& point : fit.history) {
    CHECK(point.parameters.get_or(free[0].key, 9.0) <= 0.38);
  }
}

TEST_CASE("a prior decides what the data leave open", "[calibrator]") {
  toy::Study study = toy::two_of_three(0.3);
  study.calibration.free[2].prior = Prior{0.3, 0.05};
  const Fit fit = solve(study);
  check_complete(study, fit);
  CHECK(fit.stop == StopReason::hit);
  CHECK(fit.parameters[2].value == Approx(0.3).margin(0.05));
  CHECK(fit.parameters[2].lower == Approx(0.3 - 1.96 * 0.05).margin(0.03));
  CHECK(fit.parameters[2].upper == Approx(0.3 + 1.96 * 0.05).margin(0.03));
  CHECK(fit.parameters[2].learnt < 0.1);  // it was known, not learnt
  CHECK(fit.posterior.quantiles[2][1] == Approx(0.3).margin(0.02));
}

TEST_CASE("a limit of time ends the search with its confirmation paid for", "[calibrator][slow]") {
  toy::Study study = toy::granular(6, 1.5, 1, 70, 4);
  study.calibration.budget.core_seconds = 50.0;
  int asked = 0;
  const auto evaluator = [&](std::span<const engine::Trial> trials) {
    asked += static_cast<int>(trials.size());
    return toy::evaluator(study)(trials);
  };
  const Meter meter = [&] { return Spent{2.0 * asked, 0.5 * asked}; };
  const Fit by_cores = calibrate(study.calibration, evaluator, {.meter = meter});
  CHECK(by_cores.stop == StopReason::budget);
  CHECK(asked <= 25);
  CHECK(asked > 20);
  CHECK(by_cores.predictions[0].replicates >= 4);
  CHECK(mentions(by_cores, "The limit of time ended the search"));

  asked = 0;
  check_equal(by_cores, calibrate(study.calibration, evaluator, {.meter = meter}));

  study.calibration.budget.core_seconds = {};
  study.calibration.budget.wall_seconds = 12.5;
  asked = 0;
  CHECK(calibrate(study.calibration, evaluator, {.meter = meter}).evaluations ==
        by_cores.evaluations);
}

TEST_CASE("the next batch is a function of what was answered before", "[calibrator][slow]") {
  const toy::Study study = toy::granular(6, 0.5, 4, 40, 4);
  std::vector<std::vector<engine::Trial>> batches;
  std::vector<std::vector<engine::Evaluation>> answers;
  calibrate(study.calibration, [&](std::span<const engine::Trial> trials) {
    batches.emplace_back(trials.begin(), trials.end());
    answers.push_back(toy::evaluator(study)(trials));
    return answers.back();
  });
  REQUIRE(batches.size() > 4);
  // Killed after each batch in turn: the fresh process is told what was stored and asks on.
  for (std::size_t known = 0; known < batches.size(); ++known) {
    std::size_t asked = 0;
    std::vector<engine::Trial> next;
    const Evaluator replay = [&](std::span<const engine::Trial> trials) {
      if (asked < known) return answers[asked++];
      next.assign(trials.begin(), trials.end());
      throw std::runtime_error("killed");
    };
    CHECK_THROWS_WITH(calibrate(study.calibration, replay), "killed");
    CHECK(next == batches[known]);
  }
}
