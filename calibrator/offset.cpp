#include "calibrator/offset.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace repose::calibrator {
namespace {

struct Estimate {
  double value = 0.0;
  double variance = 0.0;
};

/// Confirmed minus searched of the runs that share a seed.
std::vector<SiteRun> differences(const Site& site) {
  std::vector<SiteRun> result;
  for (const SiteRun& high : site.confirmed) {
    const auto low = std::ranges::find(site.searched, high.replicate, &SiteRun::replicate);
    if (low == site.searched.end()) continue;
    result.push_back(high);
    for (std::size_t j = 0; j < high.values.size(); ++j) {
      result.back().values[j] -= low->values[j];
    }
  }
  return result;
}

std::optional<Estimate> estimate(const Site& site,
                                 std::size_t measurement,
                                 const Surrogate& surrogate,
                                 double low_variance,
                                 double high_variance) {
  const RunMean pairs = mean_of(differences(site), measurement);
  if (pairs.count >= 2) {
    return Estimate{pairs.mean, run_variance(pairs, low_variance + high_variance) / pairs.count};
  }
  const RunMean runs = mean_of(site.confirmed, measurement);
  const Belief belief = surrogate.at(measurement, site.at);
  if (runs.count == 0 || !std::isfinite(belief.mean)) return std::nullopt;
  return Estimate{runs.mean - belief.mean,
                  run_variance(runs, high_variance) / runs.count + belief.variance};
}

}  // namespace

Offset learn_offset(const Ledger& ledger, const Surrogate& surrogate, std::size_t latest) {
  const std::size_t count = surrogate.size();
  Offset offset{std::vector<double>(count, 0.0), std::vector<double>(count, 0.0)};
  if (!ledger.two_levels()) return offset;
  const Scatter low = ledger.scatter(Level::search);
  const Scatter high = ledger.scatter(Level::confirm);
  for (std::size_t j = 0; j < count; ++j) {
    const auto at = [&](std::size_t site) {
      return estimate(ledger.sites()[site], j, surrogate, low.variance[j], high.variance[j]);
    };
    const auto last = at(latest);
    double weights = 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < ledger.sites().size(); ++i) {
      if (ledger.sites()[i].confirmed.empty()) continue;
      const auto here = at(i);
      if (!here) continue;
      double variance = here->variance;
      if (last && i != latest) {
        const double gap = here->value - last->value;
        variance += std::max(0.0, gap * gap - here->variance - last->variance);
      }
      weights += 1.0 / variance;
      sum += here->value / variance;
    }
    if (weights > 0.0) {
      offset.value[j] = sum / weights;
      offset.variance[j] = 1.0 / weights;
    }
  }
  return offset;
}

}  // namespace repose::calibrator
