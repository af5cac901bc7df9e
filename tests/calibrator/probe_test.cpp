#include "calibrator/probe.hpp"

#include <catch2/catch.hpp>

#include "tests/support/toy_study.hpp"

using namespace repose;
using namespace repose::calibrator;

namespace {

toy::Study study(toy::Response response) {
  toy::Study study;
  study.response = std::move(response);
  study.sigma = {0.5, 0.5};
  study.truth = {0.4, 0.6, 0.5};
  return toy::ask(std::move(study), 1, 60, 4);
}

}  // namespace

TEST_CASE("the parameter that no measurement feels is found, and no other", "[calibrator]") {
  const toy::Study blind = study([](std::span<const double> u) {
    return std::vector<double>{u[0], u[1]};
  });
  CHECK(unfelt_parameters(blind.calibration, toy::evaluator(blind)) == std::vector<std::size_t>{2});
  const toy::Study weak = study([](std::span<const double> u) {
    return std::vector<double>{u[0], u[1] + 1e-9 * u[2]};
  });
  CHECK(unfelt_parameters(weak.calibration, toy::evaluator(weak)).empty());
}

TEST_CASE("a parameter that only a held-out measurement feels is not felt", "[calibrator]") {
  toy::Study out = study([](std::span<const double> u) {
    return std::vector<double>{u[0] + u[1], u[2]};
  });
  out.calibration.measurements[1].role = Role::held_out;
  CHECK(unfelt_parameters(out.calibration, toy::evaluator(out)) == std::vector<std::size_t>{2});
}

TEST_CASE("a run that fails is no evidence that a parameter is not felt", "[calibrator]") {
  toy::Study failing = study([](std::span<const double> u) {
    return std::vector<double>{u[0], u[1]};
  });
  failing.fails = [](std::span<const double> u) { return u[2] > 0.9; };
  CHECK(unfelt_parameters(failing.calibration, toy::evaluator(failing)).empty());
}
