#include "calibrator/offset.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/known_ledger.hpp"

using namespace repose;
using namespace repose::calibrator;

namespace {

toy::Study biased(double bias) {
  toy::Study study = toy::two_of_three(0.2);
  study.draft_bias = [bias](auto) { return std::vector<double>{bias, 0.0}; };
  study.calibration.budget.fidelity = engine::Fidelity::draft;
  return study;
}

void run_at(toy::Known& known, std::size_t site, int count, int first, Level level) {
  std::vector<Ledger::Request> requests;
  requests.reserve(static_cast<std::size_t>(count));
  for (int r = 0; r < count; ++r) requests.push_back({site, first + r, level});
  known.ledger().run("pair", requests);
}

}  // namespace

TEST_CASE("there is no offset where there is one fidelity", "[calibrator]") {
  const toy::Known known(toy::two_of_three(0.2), 8);
  const Offset offset = learn_offset(known.outlook().ledger, known.outlook().surrogate, 0);
  CHECK(offset.value == std::vector<double>{0.0, 0.0});
  CHECK(offset.variance == std::vector<double>{0.0, 0.0});
}

TEST_CASE("paired runs with equal scatter give the offset exactly", "[calibrator]") {
  // The toy's noise depends on the seed alone, so pairs differ by the bias and nothing else.
  toy::Known known(biased(1.5), 8, 4);
  run_at(known, 0, 4, 0, Level::confirm);
  const Offset offset = learn_offset(known.outlook().ledger, known.outlook().surrogate, 0);
  CHECK(offset.value[0] == Approx(-1.5));
  CHECK(offset.value[1] == Approx(0.0).margin(1e-12));
  CHECK(std::sqrt(offset.variance[0]) < 0.1);  // scatter of a run: 0.1
  CHECK(offset.variance[0] > 0.0);             // four pairs are no proof of a perfect pairing
}

TEST_CASE("runs without a partner are held against the emulator", "[calibrator]") {
  toy::Known known(biased(1.5), 15, 2);
  run_at(known, 3, 4, 50, Level::confirm);
  const Offset offset = learn_offset(known.outlook().ledger, known.outlook().surrogate, 3);
  const double error = std::sqrt(offset.variance[0]);
  CHECK(std::abs(offset.value[0] + 1.5) < 4.0 * error);
  CHECK(error < 0.2);  // four runs of scatter 0.1, and an emulator that knows as much
}

TEST_CASE("where sites disagree the latest is believed", "[calibrator]") {
  toy::Study study = biased(0.0);
  study.draft_bias = [](std::span<const double> u) { return std::vector<double>{4.0 * u[0], 1.0}; };
  toy::Known known(study, 8, 4);
  run_at(known, 0, 4, 0, Level::confirm);
  run_at(known, 1, 4, 0, Level::confirm);
  const Offset offset = learn_offset(known.outlook().ledger, known.outlook().surrogate, 1);
  const double first = -4.0 * known.outlook().ledger.sites()[0].at[0];
  const double latest = -4.0 * known.outlook().ledger.sites()[1].at[0];
  REQUIRE(std::abs(first - latest) > 0.5);
  CHECK(std::abs(offset.value[0] - latest) < 0.1 * std::abs(first - latest));
  CHECK(offset.value[1] == Approx(-1.0));  // there they agree
  CHECK(offset.variance[1] < offset.variance[0]);
}
