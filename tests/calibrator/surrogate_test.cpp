#include "calibrator/surrogate.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "calibrator/design.hpp"
#include "engine/random.hpp"

using namespace repose;
using namespace repose::calibrator;

namespace {

double matern(double r) {
  const double t = std::sqrt(5.0) * r;
  return (1.0 + t + t * t / 3.0) * std::exp(-t);
}

std::vector<Sample> sampled(std::size_t count,
                            std::size_t d,
                            double noise,
                            const std::function<double(const UnitPoint&)>& f) {
  std::vector<Sample> samples;
  engine::Random random(11, engine::Purpose::grain_size);
  for (const UnitPoint& u : spread_design(count, d, 2)) {
    samples.push_back({u, f(u) + noise * random.normal(), std::max(noise * noise, 1e-8)});
  }
  return samples;
}

GaussianProcess fitted(std::vector<Sample> samples) {
  const std::vector<Hyperparameters> starts{prior_mode(samples.front().at.size())};
  return GaussianProcess::fit(std::move(samples), starts);
}

}  // namespace

TEST_CASE("two samples give the mean and variance worked out by hand", "[calibrator]") {
  // Samples -1 at u = 0.2 and +1 at u = 0.8: mean 0 and deviation 1, so standardising changes
  // nothing. By symmetry m = 0. K = [[a, b], [b, a]], a = s + 0.27 + n, b = s M(1) - 0.27 at l =
  // 0.6.
  const double s = 0.5;
  const double n = 0.01;
  const GaussianProcess process({{{0.2}, -1.0, n}, {{0.8}, 1.0, n}}, {{0.6}, s, 1.0});
  const double a = s + 3.0 * 0.09 + n;
  const double b = s * matern(1.0) - 3.0 * 0.09;
  const double u = 0.35;
  const double k1 = s * matern(0.25) + 3.0 * (u - 0.5) * -0.3;
  const double k2 = s * matern(0.75) + 3.0 * (u - 0.5) * 0.3;
  const double mean = (k2 - k1) / (a - b);
  const double det = a * a - b * b;
  const double known = (a * (k1 * k1 + k2 * k2) - 2.0 * b * k1 * k2) / det;
  const double ones = 2.0 / (a + b);  // 1' K^-1 1
  const double rest = 1.0 - (k1 + k2) / (a + b);
  const double variance = s + 3.0 * 0.0225 - known + rest * rest / ones;
  const Belief belief = process.at(UnitPoint{u});
  // The jitter on the diagonal is 1e-9.
  CHECK(belief.mean == Approx(mean).epsilon(1e-7));
  CHECK(belief.variance == Approx(variance).epsilon(1e-7));
}

TEST_CASE("a process passes through samples without noise and knows it", "[calibrator]") {
  const auto f = [](const UnitPoint& u) { return 300.0 + 20.0 * std::sin(3.0 * u[0]) * u[1]; };
  const auto samples = sampled(20, 2, 0.0, f);
  const GaussianProcess process = fitted(samples);
  for (const Sample& sample : samples) {
    const Belief belief = process.at(sample.at);
    CHECK(belief.mean == Approx(sample.value).margin(1e-3));
    CHECK(std::sqrt(belief.variance) < 1e-2);  // of a range of 20
  }
}

TEST_CASE("a smooth function is predicted from few samples within its own error bars",
          "[calibrator]") {
  const auto f = [](const UnitPoint& u) {
    return 3.0 * u[0] + std::exp(-2.0 * u[1]) + u[0] * u[2];
  };
  const GaussianProcess process = fitted(sampled(20, 3, 0.01, f));
  double mean_square = 0.0;
  double largest = 0.0;
  const auto points = latin_hypercube(200, 3, 99);
  for (const UnitPoint& u : points) {
    const Belief belief = process.at(u);
    mean_square += std::pow(belief.mean - f(u), 2) / belief.variance / 200.0;
    largest = std::max(largest, std::abs(belief.mean - f(u)));
  }
  // 200 points share 20 samples: their standardised errors are far from independent, so a factor of
  // three either way is all that can be asked. The function's range is about 5.
  CHECK(mean_square < 3.0);
  CHECK(largest < 0.25);
}

TEST_CASE("the gradient is the slope of the mean", "[calibrator]") {
  const auto f = [](const UnitPoint& u) { return std::sin(4.0 * u[0]) + u[1] * u[2]; };
  const GaussianProcess process = fitted(sampled(15, 3, 0.05, f));
  const UnitPoint u{0.3, 0.6, 0.45};
  const Eigen::VectorXd gradient = process.gradient(u);
  for (std::size_t k = 0; k < 3; ++k) {
    UnitPoint up = u;
    UnitPoint down = u;
    up[k] += 1e-5;
    down[k] -= 1e-5;
    const double slope = (process.at(up).mean - process.at(down).mean) / 2e-5;
    // Central differences: error h^2 times the third derivative, and 1e-16 / 1e-5 of rounding.
    CHECK(gradient(static_cast<Eigen::Index>(k)) == Approx(slope).epsilon(1e-6).margin(1e-7));
  }
}

TEST_CASE("joint beliefs agree with single ones", "[calibrator]") {
  const GaussianProcess process =
      fitted(sampled(12, 2, 0.1, [](const UnitPoint& u) { return u[0] * u[1]; }));
  const auto points = latin_hypercube(5, 2, 4);
  const auto joint = process.at_all(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto index = static_cast<Eigen::Index>(i);
    CHECK(joint.mean(index) == Approx(process.at(points[i]).mean));
    CHECK(joint.covariance(index, index) == Approx(process.at(points[i]).variance));
  }
  CHECK(joint.covariance.isApprox(joint.covariance.transpose()));
}

TEST_CASE("a believed run leaves the mean and narrows the belief", "[calibrator]") {
  const GaussianProcess process =
      fitted(sampled(12, 2, 0.1, [](const UnitPoint& u) { return u[0] - 2.0 * u[1]; }));
  const std::vector<UnitPoint> pending{{0.9, 0.1}};
  const GaussianProcess believed = process.believing(pending, 0.01);
  for (const UnitPoint& u : latin_hypercube(20, 2, 8)) {
    CHECK(believed.at(u).mean == Approx(process.at(u).mean).margin(1e-8));
    CHECK(believed.at(u).variance <= process.at(u).variance * (1.0 + 1e-9));
  }
  CHECK(believed.at(pending[0]).variance < process.at(pending[0]).variance);
}

TEST_CASE("samples known better narrow the belief", "[calibrator]") {
  const auto f = [](const UnitPoint& u) { return u[0]; };
  const Hyperparameters h = prior_mode(1);
  const GaussianProcess once(sampled(10, 1, 0.3, f), h);
  const GaussianProcess often(sampled(10, 1, 0.3 / 4.0, f), h);  // means of sixteen
  CHECK(often.at(UnitPoint{0.5}).variance < once.at(UnitPoint{0.5}).variance);
}

TEST_CASE("an error bar that leaving one out proves too small is widened", "[calibrator]") {
  // Steps that the smooth prior cannot expect, said to be known to 1e-4. What is believed between
  // them depends on the values by their spread and by how badly they are foretold, and not else.
  const auto steps = [](int length) {
    std::vector<Sample> samples;
    for (int i = 0; i < 12; ++i) {
      samples.push_back({{(i + 0.5) / 12.0}, i / length % 2 == 0 ? 0.0 : 1.0, 1e-8});
    }
    return GaussianProcess(samples, {{2.0}, 0.4, 1.0});
  };
  const GaussianProcess single = steps(1), pairs = steps(2);  // both half zeros and half ones
  CHECK(pairs.leave_one_out() > 2.0);
  CHECK(single.leave_one_out() > 1.5 * pairs.leave_one_out());
  const UnitPoint between{0.3};
  CHECK(single.at(between).variance / single.leave_one_out() ==
        Approx(pairs.at(between).variance / pairs.leave_one_out()).epsilon(1e-6));
}

TEST_CASE("samples that are all alike are believed without trouble", "[calibrator]") {
  std::vector<Sample> samples;
  for (const UnitPoint& u : latin_hypercube(6, 2, 1)) samples.push_back({u, 5.0, 1e-4});
  const Belief belief = fitted(samples).at(UnitPoint{0.5, 0.5});
  CHECK(belief.mean == Approx(5.0));
  CHECK(std::isfinite(belief.variance));
}
