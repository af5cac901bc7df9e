#include "calibrator/posterior.hpp"

#include <catch2/catch.hpp>

#include "engine/random.hpp"
#include "tests/support/known_ledger.hpp"

using namespace repose;
using namespace repose::calibrator;

namespace {

/// Independent normal draws, each chain about its own mean.
std::vector<std::vector<double>> chains(double apart) {
  engine::Random random(1, engine::Purpose::proposal);
  std::vector<std::vector<double>> result(8);
  for (std::size_t c = 0; c < result.size(); ++c) {
    for (int i = 0; i < 500; ++i) {
      result[c].push_back(apart * static_cast<double>(c) + random.normal());
    }
  }
  return result;
}

}  // namespace

TEST_CASE("the posterior of a linear parameter is the normal distribution of its measurement",
          "[calibrator]") {
  // y0 = 10 u0 known to 0.5, y1 = 10 u1 likewise; the third parameter moves y0 by 0.1 at most.
  const toy::Known known(toy::two_of_three(0.02), 20);
  const Posterior posterior = sample_posterior(known.outlook(), recommend(known.outlook(), {}));
  CHECK(posterior.r_hat <= 1.01);
  CHECK(posterior.effective_samples >= 1000.0);
  REQUIRE(posterior.quantiles.size() == 3);
  for (const std::size_t k : {0UL, 1UL}) {
    const double truth = known.study().truth[k];
    // A thousand samples know a 5 % quantile to 0.07 deviations; and 0.01 is the third's doing.
    CHECK(posterior.quantiles[k][0] == Approx(truth - 1.645 * 0.05).margin(0.02));
    CHECK(posterior.quantiles[k][1] == Approx(truth).margin(0.015));
    CHECK(posterior.quantiles[k][2] == Approx(truth + 1.645 * 0.05).margin(0.02));
  }
  CHECK(posterior.quantiles[2][0] == Approx(0.05).margin(0.04));
  CHECK(posterior.quantiles[2][2] == Approx(0.95).margin(0.04));
  CHECK(posterior.samples.size() == 256);
}

TEST_CASE("no sample of the posterior breaks a constraint", "[calibrator]") {
  toy::Study study = toy::two_of_three(0.02);
  study.calibration.constraints.push_back({{{study.calibration.free[0].key, 1.0}}, 0.38, {}});
  const toy::Known known(std::move(study), 20);
  const Posterior posterior = sample_posterior(known.outlook(), {0.38, 0.6, 0.5});
  REQUIRE(!posterior.samples.empty());
  for (const auto& sample : posterior.samples) CHECK(sample[0] <= 0.38);
}

TEST_CASE("independent draws have converged and are all effective", "[calibrator]") {
  const Convergence here = convergence(chains(0.0));
  CHECK(here.r_hat < 1.02);
  CHECK(here.effective == Approx(4000.0).epsilon(0.3));
}

TEST_CASE("chains about different means have not converged", "[calibrator]") {
  CHECK(convergence(chains(1.0)).r_hat > 1.5);
  CHECK(convergence(chains(1.0)).effective < 100.0);
}
