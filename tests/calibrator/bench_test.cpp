/// The analytic bench with its asks. A few seeds are run
/// always, twenty under [slow]. The fast asks are those of the twenty: a method that meets them on
/// the whole can fail one seed in ten, so the fast set allows one.

#include <algorithm>
#include <string>

#include <catch2/catch.hpp>

#include "tests/support/bench_run.hpp"

using namespace repose;
using toy::BenchRun;

namespace {

std::vector<BenchRun> over_seeds(std::uint64_t count,
                                 const std::function<toy::Study(std::uint64_t)>& make) {
  std::vector<BenchRun> runs;
  for (std::uint64_t seed = 1; seed <= count; ++seed) runs.push_back(toy::bench(make(seed)));
  return runs;
}

std::string summary(const std::vector<BenchRun>& runs) {
  return "median " + std::to_string(toy::quantile(runs, 0.5)) + ", 90th percentile " +
         std::to_string(toy::quantile(runs, 0.9)) + " of " + std::to_string(runs.size());
}

double false_hits(const std::vector<BenchRun>& runs) {
  const auto declared = std::ranges::count_if(
      runs, [](const BenchRun& r) { return r.fit.stop == calibrator::StopReason::hit; });
  const auto wrong = std::ranges::count_if(runs, [](const BenchRun& r) {
    return r.fit.stop == calibrator::StopReason::hit && !r.truly_hit;
  });
  return declared == 0 ? 0.0 : static_cast<double>(wrong) / static_cast<double>(declared);
}

}  // namespace

TEST_CASE("five parameters, two observables: solved within 40 evaluations", "[calibrator]") {
  const auto runs = over_seeds(5, [](auto seed) { return toy::granular(2, 0.5, seed, 60, 4); });
  CHECK(toy::quantile(runs, 0.5) <= 20);
  CHECK(toy::share_solved(runs, 40) >= 0.8);
  for (const BenchRun& run : runs) {
    // Two numbers cannot determine more than two directions.
    CHECK(std::ranges::count_if(run.fit.directions, [](const auto& d) { return d.learnt; }) <= 2);
  }
}

TEST_CASE("five parameters, six observables: solved within 40 evaluations", "[calibrator][slow]") {
  const auto runs = over_seeds(5, [](auto seed) { return toy::granular(6, 0.5, seed, 60, 4); });
  CHECK(toy::quantile(runs, 0.5) <= 25);
  CHECK(toy::share_solved(runs, 40) >= 0.8);
}

TEST_CASE("A1: bench A over twenty seeds", "[calibrator][slow]") {
  const auto runs = over_seeds(20, [](auto seed) { return toy::granular(2, 0.5, seed, 70, 4); });
  WARN("bench A: " << summary(runs));
  CHECK(toy::quantile(runs, 0.5) <= 20);
  CHECK(toy::share_solved(runs, 40) >= 0.9);
  CHECK(false_hits(runs) <= 0.1);
}

TEST_CASE("A2: bench C over twenty seeds, four and eight at a time", "[calibrator][slow]") {
  const auto runs = over_seeds(20, [](auto seed) { return toy::granular(6, 0.5, seed, 70, 4); });
  WARN("bench C: " << summary(runs));
  CHECK(toy::quantile(runs, 0.5) <= 25);
  CHECK(toy::share_solved(runs, 40) >= 0.9);
  CHECK(false_hits(runs) <= 0.1);

  const auto wide = over_seeds(20, [](auto seed) { return toy::granular(6, 0.5, seed, 70, 8); });
  WARN("bench C, eight at a time: " << summary(wide));
  const auto quick = std::ranges::count_if(wide, [](const BenchRun& run) {
    return run.solved_at > 0 && run.solved_at <= 40 && run.rounds_to_solve <= 6;
  });
  CHECK(quick >= 18);
}

TEST_CASE("A3: bench D over twenty seeds", "[calibrator][slow]") {
  const auto runs = over_seeds(20, [](auto seed) { return toy::eight_by_eight(seed, 100, 4); });
  WARN("bench D: " << summary(runs));
  CHECK(toy::quantile(runs, 0.5) <= 45);
  CHECK(toy::share_solved(runs, 80) >= 0.8);
}

TEST_CASE("A4: bench E, three times the noise, over forty seeds", "[calibrator][slow]") {
  const auto runs = over_seeds(40, [](auto seed) { return toy::granular(6, 1.5, seed, 70, 4); });
  WARN("bench E: " << summary(runs) << ", solved within 70: " << toy::share_solved(runs, 70));
  CHECK(toy::share_solved(runs, 70) >= 0.7);
  CHECK(false_hits(runs) <= 0.1);
}
