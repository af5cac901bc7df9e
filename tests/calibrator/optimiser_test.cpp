#include "calibrator/optimiser.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

#include <catch2/catch.hpp>

using namespace repose::calibrator;

namespace {

/// Smallest at the given point.
Objective bowl(std::vector<double> centre) {
  return [centre = std::move(centre)](std::span<const double> x) {
    double sum = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      sum += static_cast<double>(k + 1) * (x[k] - centre[k]) * (x[k] - centre[k]);
    }
    return sum;
  };
}

}  // namespace

TEST_CASE("a local search finds the bottom of a bowl in one to eight dimensions", "[calibrator]") {
  for (const std::size_t d : {1UL, 2UL, 5UL, 8UL}) {
    const std::vector<double> centre(d, 0.3);
    const Minimum found = minimise_locally(
        bowl(centre), unit_box(d), std::vector<double>(d, 0.8), {.evaluations = 300});
    // The tolerance asked for is 1e-4 on the coordinates; ten times that leaves room for its stop
    // rule.
    for (const double x : found.at) CHECK(std::abs(x - 0.3) < 1e-3);
  }
}

TEST_CASE("a minimum beyond the box is found on its face, exactly inside", "[calibrator]") {
  const Minimum found =
      minimise_locally(bowl({-0.5, 0.4, 1.7}), unit_box(3), {0.5, 0.5, 0.5}, {.evaluations = 200});
  CHECK(found.at[0] == Approx(0.0).margin(1e-3));
  CHECK(found.at[2] == Approx(1.0).margin(1e-3));
  for (const double x : found.at) {
    CHECK(x >= 0.0);
    CHECK(x <= 1.0);
  }
}

TEST_CASE("a global search leaves the wrong basin", "[calibrator]") {
  // Two wells; the deeper is narrow and far from the start.
  const Objective wells = [](std::span<const double> x) {
    const auto well = [&](double a, double b, double depth, double width) {
      const double r2 = (x[0] - a) * (x[0] - a) + (x[1] - b) * (x[1] - b);
      return -depth * std::exp(-r2 / (width * width));
    };
    return well(0.2, 0.2, 1.0, 0.4) + well(0.85, 0.75, 1.5, 0.15);
  };
  const std::vector<std::vector<double>> starts{{0.2, 0.2}};
  const Minimum found = minimise(wells, unit_box(2), starts, 200);
  CHECK(std::abs(found.at[0] - 0.85) < 0.01);  // the wide well shifts it by less
  CHECK(std::abs(found.at[1] - 0.75) < 0.01);
}

TEST_CASE("the value returned is the function's at the point returned", "[calibrator]") {
  const Objective f = bowl({0.21, 0.77});
  const Minimum found = minimise(f, unit_box(2), {}, 100);
  CHECK(found.value == f(found.at));
}

TEST_CASE("NaN is never the minimum", "[calibrator]") {
  const Objective f = [](std::span<const double> x) {
    return x[0] > 0.5 ? std::numeric_limits<double>::quiet_NaN()
                      : (x[0] - 0.4) * (x[0] - 0.4) + x[1];
  };
  const Minimum found = minimise(f, unit_box(2), {}, 200, {.evaluations = 200});
  CHECK(found.at[0] == Approx(0.4).margin(0.02));  // the wall of NaN spoils the quadratic model
}

TEST_CASE("an exception of the function comes out as itself", "[calibrator]") {
  int calls = 0;
  const Objective f = [&](std::span<const double>) -> double {
    if (++calls == 5) throw std::runtime_error("no more");
    return 1.0;
  };
  CHECK_THROWS_WITH(minimise_locally(f, unit_box(3), {0.5, 0.5, 0.5}), "no more");
  CHECK(calls == 5);
}

TEST_CASE("a search gives the same bits on another thread", "[calibrator]") {
  const Objective f = bowl({0.21, 0.77, 0.5});
  const Minimum here = minimise(f, unit_box(3), {}, 150);
  Minimum there;
  std::thread([&] { there = minimise(f, unit_box(3), {}, 150); }).join();
  CHECK(here.at == there.at);
}

TEST_CASE("a cube without dimensions has one point", "[calibrator]") {
  const Minimum found = minimise([](std::span<const double>) { return 3.0; }, unit_box(0), {}, 10);
  CHECK(found.at.empty());
  CHECK(found.value == 3.0);
}

TEST_CASE("where a relation cuts off the bottom of a bowl, the lowest point left is found",
          "[calibrator]") {
  // u0 + u1 <= 0.8 with the bottom at (0.6, 0.6): by Lagrange's multiplier of the weights 1 and 2,
  // u0 = 0.6 - 0.4 * 2/3, u1 = 0.6 - 0.4 / 3.
  Box box = unit_box(2);
  box.excesses.emplace_back([](std::span<const double> x) { return x[0] + x[1] - 0.8; });
  const std::vector<std::vector<double>> starts{{0.1, 0.1}};
  const Minimum found = minimise(bowl({0.6, 0.6}), box, starts, 200, {.evaluations = 200});
  CHECK(found.at[0] == Approx(0.6 - 0.4 * 2.0 / 3.0).margin(2e-3));
  CHECK(found.at[1] == Approx(0.6 - 0.4 / 3.0).margin(2e-3));
  CHECK(found.at[0] + found.at[1] <= 0.8);
}

TEST_CASE("where no point keeps the relations the minimum is infinite", "[calibrator]") {
  Box box = unit_box(2);
  box.excesses.emplace_back([](std::span<const double>) { return 1.0; });
  CHECK(std::isinf(minimise_locally(bowl({0.6, 0.6}), box, {0.1, 0.1}).value));
}
