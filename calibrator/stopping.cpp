#include "calibrator/stopping.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <Eigen/Cholesky>

#include "calibrator/design.hpp"
#include "calibrator/optimiser.hpp"
#include "engine/random.hpp"

namespace repose::calibrator {
namespace {

using Eigen::Index;

constexpr std::uint64_t candidate_design = 1'000'000;  // apart from the designs that are evaluated

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// The points that could be better than the recommended one, which is the first.
std::vector<UnitPoint> promising(const Outlook& outlook, const UnitPoint& recommended) {
  const std::size_t d = recommended.size();
  const std::uint64_t seed = outlook.ledger.calibration().seed;
  const SearchSpace& space = outlook.ledger.space();
  std::vector<UnitPoint> pool = allowed_points(space, 2000, seed, candidate_design);
  for (UnitPoint& near : latin_hypercube(200, d, seed, candidate_design + 1)) {
    for (std::size_t k = 0; k < d; ++k) {  // a fifth of the cube around the recommended point
      near[k] = std::clamp(recommended[k] + 0.2 * (near[k] - 0.5), 0.0, 1.0);
    }
    if (space.allows(near)) pool.push_back(std::move(near));
  }
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t i = 0; i < pool.size(); ++i) {
    double mean = space.prior_misfit(pool[i]);
    double variance = 0.0;
    for (const Residual& r : residuals(outlook.surrogate, outlook.targets, pool[i])) {
      const double b2 = r.deviation * r.deviation;
      mean += r.mean * r.mean + b2;
      variance += 2.0 * b2 * b2 + 4.0 * r.mean * r.mean * b2;
    }
    ranked.emplace_back(mean - 2.0 * std::sqrt(variance), i);
  }
  const std::size_t kept = std::min<std::size_t>(199, ranked.size());
  std::ranges::partial_sort(ranked, ranked.begin() + static_cast<std::ptrdiff_t>(kept));
  std::vector<UnitPoint> result{recommended};
  for (std::size_t i = 0; i < kept; ++i) result.push_back(std::move(pool[ranked[i].second]));
  return result;
}

/// Whether the mean of each fitted measurement, moved away from the target by so many of its
/// standard errors, is within the measurement's.
bool within(const Ledger& ledger, std::span<const SiteRun> replicates, double errors) {
  const auto& measurements = ledger.calibration().measurements;
  const Scatter scatter = ledger.scatter(Level::confirm);
  for (std::size_t j = 0; j < measurements.size(); ++j) {
    if (measurements[j].role != Role::fit) continue;
    const RunMean runs = mean_of(replicates, j);
    if (runs.count < 2 || runs.count < static_cast<int>(replicates.size())) return false;
    const double error = std::sqrt(run_variance(runs, scatter.variance[j]) / runs.count);
    const double sigma = standard_uncertainty(measurements[j]);
    if (std::abs(runs.mean - measurements[j].value) + errors * error > sigma) return false;
  }
  return true;
}

}  // namespace

int confirming_replicates(const Ledger& ledger) {
  const auto& measurements = ledger.calibration().measurements;
  const Scatter low = ledger.scatter(Level::search);
  const Scatter high = ledger.scatter(Level::confirm);
  double most = 0.0;
  for (std::size_t j = 0; j < measurements.size(); ++j) {
    if (measurements[j].role != Role::fit) continue;
    const double variance = high.freedom[j] > 0 ? high.variance[j] : low.variance[j];
    const double sigma = standard_uncertainty(measurements[j]);
    most = std::max(most, variance / (0.09 * sigma * sigma));
  }
  return static_cast<int>(std::clamp(std::ceil(most), 4.0, 8.0));
}

bool is_hit(const Ledger& ledger, std::span<const SiteRun> replicates) {
  return within(ledger, replicates, 1.0);
}

bool may_be_hit(const Ledger& ledger, std::span<const SiteRun> replicates) {
  return within(ledger, replicates, -2.0);
}

double probability_of_hit(const Outlook& outlook, const UnitPoint& point, int replicates) {
  const Scatter scatter = outlook.ledger.scatter(Level::search);
  double probability = 1.0;
  for (const Target& target : outlook.targets) {
    const double sigma =
        standard_uncertainty(outlook.ledger.calibration().measurements[target.measurement]);
    const Belief belief = outlook.surrogate.at(target.measurement, point);
    const double of_mean = scatter.variance[target.measurement] / replicates;
    const double of_offset = target.variance - sigma * sigma;
    const double reach = sigma - std::sqrt(of_mean);
    const double spread = std::sqrt(belief.variance + of_mean + std::max(of_offset, 0.0));
    const double gap = belief.mean - target.value;
    if (reach <= 0.0) return 0.0;
    probability *= normal_cdf((reach - gap) / spread) - normal_cdf((-reach - gap) / spread);
  }
  return probability;
}

double probability_of_better(const Outlook& outlook, const UnitPoint& recommended) {
  if (recommended.empty()) return 0.0;
  constexpr int draws = 128;
  const std::vector<UnitPoint> points = promising(outlook, recommended);
  const auto count = static_cast<Index>(points.size());
  Eigen::ArrayXXd misfits(count, draws);
  for (Index i = 0; i < count; ++i) {
    misfits.row(i) = outlook.ledger.space().prior_misfit(points[static_cast<std::size_t>(i)]);
  }
  engine::Random random(outlook.ledger.calibration().seed, engine::Purpose::proposal, 1);
  for (const Target& target : outlook.targets) {
    const auto joint = outlook.surrogate.process(target.measurement)->at_all(points);
    Eigen::MatrixXd covariance = joint.covariance / target.variance;
    covariance.diagonal().array() += 1e-6;  // in units of the measurement's variance: nothing
    const Eigen::MatrixXd root = covariance.llt().matrixL();
    Eigen::MatrixXd normals(count, draws);
    for (Index s = 0; s < draws; ++s) {
      for (Index i = 0; i < count; ++i) normals(i, s) = random.normal();
    }
    const Eigen::ArrayXd means = (joint.mean.array() - target.value) / std::sqrt(target.variance);
    misfits += ((root.triangularView<Eigen::Lower>() * normals).array().colwise() + means).square();
  }
  const double epsilon = std::max({0.5,
                                   0.05 * static_cast<double>(outlook.targets.size()),
                                   0.2 * expected_misfit(outlook, recommended)});
  int better = 0;
  for (Index s = 0; s < draws; ++s) {
    if (misfits.col(s).minCoeff() < misfits(0, s) - epsilon) ++better;
  }
  return static_cast<double>(better) / draws;
}

double least_implausibility(const Outlook& outlook, const UnitPoint& recommended) {
  const Scatter scatter = outlook.ledger.scatter(Level::search);
  const int replicates = confirming_replicates(outlook.ledger);
  const Objective objective = [&](std::span<const double> point) {
    std::vector<double> each;
    for (const Target& target : outlook.targets) {
      const Belief belief = outlook.surrogate.at(target.measurement, point);
      const double variance =
          belief.variance + scatter.variance[target.measurement] / replicates + target.variance;
      each.push_back(std::abs(belief.mean - target.value) / std::sqrt(variance));
    }
    std::ranges::sort(each, std::greater<>());
    return each.size() >= 6 ? each[1] : each[0];
  };
  const std::size_t d = recommended.size();
  const std::vector<UnitPoint> starts{recommended};
  return minimise(objective,
                  outlook.ledger.space().box(),
                  starts,
                  100 * static_cast<int>(d),
                  {.evaluations = 100})
      .value;
}

}  // namespace repose::calibrator
