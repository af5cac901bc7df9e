// What the calibrator itself takes of one core, beside the simulations: eight parameters and eight
// observables. The calibrator may take half a second at 60 evaluations, five at 200, and half a
// minute for the posterior and the profiles.
#include <catch2/catch.hpp>

#include "calibrator/bench/analytic_study.hpp"
#include "calibrator/posterior.hpp"
#include "calibrator/uncertainty.hpp"
#include "tests/support/known_ledger.hpp"

using namespace repose;
using namespace repose::calibrator;

namespace {

toy::Known eight_by_eight(std::size_t evaluations) {
  return {bench::eight_by_eight(1, 400, 4), evaluations, 1};
}

}  // namespace

TEST_CASE("a proposal: the emulators fitted anew, the recommendation, a batch of one",
          "[benchmark]") {
  for (const std::size_t evaluations : {60, 200}) {
    const toy::Known known = eight_by_eight(evaluations);
    BENCHMARK("proposal after " + std::to_string(evaluations) + " evaluations") {
      const Surrogate surrogate(known.outlook().ledger, nullptr);
      const Outlook outlook{known.outlook().ledger, surrogate, known.outlook().targets};
      return propose(outlook, recommend(outlook, {}), 1, 0);
    };
  }
}

TEST_CASE("posterior and profiles", "[benchmark]") {
  const toy::Known known = eight_by_eight(60);
  const UnitPoint best = recommend(known.outlook(), {});
  BENCHMARK("posterior after 60 evaluations") { return sample_posterior(known.outlook(), best); };
  BENCHMARK("profiles after 60 evaluations") { return profile_intervals(known.outlook(), best); };
}
