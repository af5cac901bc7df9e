#include "server/nightly/drift.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace repose::server {

namespace {

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// x of a x = b, a being an M-matrix, which needs no pivots.
std::vector<double> solve(std::vector<std::vector<double>> a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

}  // namespace

double run_length(double limit) {
  constexpr std::size_t states = 101;  // odd, so that one is centred at zero
  const double reach = limit * std::sqrt(drift_weight / (2.0 - drift_weight));
  const double half = reach / static_cast<double>(states);
  const auto centre = [&](std::size_t i) {
    return -reach + (2.0 * static_cast<double>(i) + 1.0) * half;
  };
  std::vector<std::vector<double>> a(states, std::vector<double>(states));
  for (std::size_t i = 0; i < states; ++i) {
    const double kept = (1.0 - drift_weight) * centre(i);
    for (std::size_t j = 0; j < states; ++j) {
      const double above = normal_cdf((centre(j) + half - kept) / drift_weight);
      const double below = normal_cdf((centre(j) - half - kept) / drift_weight);
      a[i][j] = (i == j ? 1.0 : 0.0) - (above - below);
    }
  }
  return solve(std::move(a), std::vector<double>(states, 1.0))[states / 2];
}

double limit_for(double wanted) {
  double low = 0.5;
  double high = 6.0;
  for (int halving = 0; halving < 30; ++halving) {
    const double middle = 0.5 * (low + high);
    (run_length(middle) < wanted ? low : high) = middle;
  }
  return high;
}

Drift advance(const Drift& before, const Estimate& point, double limit) {
  Drift drift = before.alarm ? Drift{} : before;
  drift.limit = limit * std::sqrt(drift_weight / (2.0 - drift_weight));
  const double precision = 1.0 / (point.standard_error * point.standard_error);
  if (drift.points > 0) {
    const double q =
        (point.value - drift.centre) / std::sqrt(1.0 / precision + 1.0 / drift.precision);
    drift.level = (1.0 - drift_weight) * drift.level + drift_weight * q;
    drift.alarm = std::abs(drift.level) > drift.limit;
  }
  ++drift.points;
  drift.precision += precision;
  drift.centre += (point.value - drift.centre) * precision / drift.precision;
  return drift;
}

}  // namespace repose::server
