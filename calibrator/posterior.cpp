#include "calibrator/posterior.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "calibrator/design.hpp"
#include "engine/random.hpp"

namespace repose::calibrator {
namespace {

constexpr std::size_t walkers = 32;  // of one ensemble, of two
constexpr std::size_t first_steps = 200;
constexpr std::size_t most_steps = 3200;
constexpr std::size_t kept_samples = 256;
constexpr double enough_samples = 1000.0;
constexpr std::uint64_t start_design = 3'000'000;  // apart from the designs that are evaluated
constexpr double impossible = -std::numeric_limits<double>::infinity();

/// log P at each of the points; minus infinity where one is not allowed.
std::vector<double> log_densities(const Outlook& outlook, const std::vector<UnitPoint>& points) {
  const SearchSpace& space = outlook.ledger.space();
  std::vector<double> result(points.size(), impossible);
  std::vector<UnitPoint> allowed;
  std::vector<std::size_t> place;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool inside =
        std::ranges::all_of(points[i], [](double u) { return u >= 0.0 && u <= 1.0; });
    if (!inside || !space.allows(points[i])) continue;
    place.push_back(i);
    allowed.push_back(points[i]);
    result[i] = space.log_prior(points[i]);
  }
  if (allowed.empty()) return result;
  for (const Target& target : outlook.targets) {
    const std::vector<Belief> beliefs =
        outlook.surrogate.process(target.measurement)->at_each(allowed);
    for (std::size_t i = 0; i < allowed.size(); ++i) {
      const double variance = beliefs[i].variance + target.variance;
      const double gap = beliefs[i].mean - target.value;
      result[place[i]] -= 0.5 * (gap * gap / variance + std::log(variance));
    }
  }
  return result;
}

/// Where the walkers start: the most likely of a design of the whole cube and one around `best`.
std::vector<UnitPoint> likely_points(const Outlook& outlook, const UnitPoint& best) {
  const SearchSpace& space = outlook.ledger.space();
  const std::uint64_t seed = outlook.ledger.calibration().seed;
  std::vector<UnitPoint> pool = allowed_points(space, 2000, seed, start_design);
  for (UnitPoint& near : latin_hypercube(500, best.size(), seed, start_design + 1)) {
    for (std::size_t k = 0; k < best.size(); ++k) {  // a tenth of the cube, moved inside it
      near[k] = std::clamp(best[k], 0.05, 0.95) + 0.1 * (near[k] - 0.5);
    }
    if (space.allows(near)) pool.push_back(std::move(near));
  }
  const std::vector<double> densities = log_densities(outlook, pool);
  std::vector<std::size_t> order(pool.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, std::greater{}, [&](std::size_t i) { return densities[i]; });
  order.resize(std::min(2 * std::max(walkers, 2 * best.size() + 2), order.size()));
  std::vector<UnitPoint> points;
  for (const std::size_t i : order) points.push_back(pool[i]);
  return points;
}

class Ensemble {
 public:
  Ensemble(const Outlook& outlook, std::vector<UnitPoint> start, std::uint64_t index)
      : outlook_(outlook),
        at_(std::move(start)),
        density_(log_densities(outlook, at_)),
        random_(outlook.ledger.calibration().seed, engine::Purpose::proposal, 2 + index) {}

  /// One step of every walker: where they are then.
  const std::vector<UnitPoint>& step() {
    const std::size_t half = at_.size() / 2;
    move(0, half, half, at_.size());
    move(half, at_.size(), 0, half);
    return at_;
  }

 private:
  /// The walkers [from, to), each along the line to one of [other, end).
  void move(std::size_t from, std::size_t to, std::size_t other, std::size_t end) {
    std::vector<UnitPoint> proposed;
    std::vector<double> bonus;
    const auto d = static_cast<double>(at_.front().size());
    for (std::size_t k = from; k < to; ++k) {
      const double root = 1.0 + random_.uniform();
      const double z = 0.5 * root * root;
      const auto j =
          other + static_cast<std::size_t>(random_.uniform() * static_cast<double>(end - other));
      proposed.push_back(at_[j]);
      for (std::size_t i = 0; i < at_[k].size(); ++i) {
        proposed.back()[i] += z * (at_[k][i] - at_[j][i]);
      }
      bonus.push_back((d - 1.0) * std::log(z));
    }
    const std::vector<double> densities = log_densities(outlook_, proposed);
    for (std::size_t k = from; k < to; ++k) {
      const std::size_t i = k - from;
      const double chance = bonus[i] + densities[i] - density_[k];
      if (!(std::log(random_.uniform()) < chance)) continue;
      at_[k] = std::move(proposed[i]);
      density_[k] = densities[i];
    }
  }

  const Outlook& outlook_;
  std::vector<UnitPoint> at_;
  std::vector<double> density_;
  engine::Random random_;
};

/// The draws of each ensemble as one chain, its walkers in turn.
std::vector<std::vector<double>> ensembles_of(const std::vector<std::vector<double>>& chains) {
  std::vector<std::vector<double>> result(2);
  for (std::size_t s = 0; s < chains.front().size(); ++s) {
    for (std::size_t w = 0; w < chains.size(); ++w) {
      result[2 * w / chains.size()].push_back(chains[w][s]);
    }
  }
  return result;
}

/// The second half of all steps, one chain per walker, of one coordinate.
std::vector<std::vector<double>> chains_of(const std::vector<std::vector<UnitPoint>>& steps,
                                           std::size_t parameter) {
  std::vector<std::vector<double>> chains(steps.front().size());
  for (std::size_t s = steps.size() / 2; s < steps.size(); ++s) {
    for (std::size_t w = 0; w < chains.size(); ++w) chains[w].push_back(steps[s][w][parameter]);
  }
  return chains;
}

double quantile_of(const std::vector<double>& sorted, double p) {
  const double place = p * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return std::lerp(sorted[low], sorted[high], place - static_cast<double>(low));
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double x : values) sum += x;
  return sum / static_cast<double>(values.size());
}

/// Sum of squares about the mean over one less than their number.
double variance_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double sum = 0.0;
  for (const double x : values) sum += (x - mean) * (x - mean);
  return sum / static_cast<double>(values.size() - 1);
}

/// What the steps say, in SI.
Posterior summary(const SearchSpace& space, const std::vector<std::vector<UnitPoint>>& steps) {
  Posterior posterior;
  const std::size_t first = steps.size() / 2;
  const std::size_t count = (steps.size() - first) * steps.front().size();
  for (std::size_t i = 0; i < kept_samples; ++i) {
    const std::size_t n = i * count / kept_samples;
    const UnitPoint& u = steps[first + n / steps.front().size()][n % steps.front().size()];
    std::vector<double> sample;
    for (std::size_t k = 0; k < u.size(); ++k) sample.push_back(space.value(k, u[k]));
    posterior.samples.push_back(std::move(sample));
  }
  posterior.effective_samples = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < space.dimensions(); ++k) {
    const auto chains = chains_of(steps, k);
    posterior.r_hat = std::max(posterior.r_hat, convergence(ensembles_of(chains)).r_hat);
    posterior.effective_samples =
        std::min(posterior.effective_samples, convergence(chains).effective);
    std::vector<double> all;
    for (const auto& chain : chains) all.insert(all.end(), chain.begin(), chain.end());
    std::ranges::sort(all);
    posterior.quantiles.push_back({space.value(k, quantile_of(all, 0.05)),
                                   space.value(k, quantile_of(all, 0.5)),
                                   space.value(k, quantile_of(all, 0.95))});
  }
  return posterior;
}

}  // namespace

/// Between and within half chains; autocorrelation by the variogram, summed until two neighbours
/// add up to less than nothing (BDA3, 11.7-11.8).
Convergence convergence(const std::vector<std::vector<double>>& chains) {
  const std::size_t n = chains.front().size() / 2;
  std::vector<std::vector<double>> halves;
  for (const auto& chain : chains) {
    const auto middle = chain.begin() + static_cast<std::ptrdiff_t>(n);
    halves.emplace_back(chain.begin(), middle);
    halves.emplace_back(middle, chain.end());
  }
  const auto length = static_cast<double>(n);
  std::vector<double> means;
  double within = 0.0;
  for (const auto& half : halves) {
    means.push_back(mean_of(half));
    within += variance_of(half) / static_cast<double>(halves.size());
  }
  const double total = (length - 1.0) / length * within + variance_of(means);
  if (!(within > 0.0)) return {std::numeric_limits<double>::infinity(), 0.0};
  const auto correlation = [&](std::size_t lag) {
    double sum = 0.0;
    for (const auto& half : halves) {
      for (std::size_t i = lag; i < n; ++i) {
        sum += (half[i] - half[i - lag]) * (half[i] - half[i - lag]);
      }
    }
    const double variogram = sum / static_cast<double>(halves.size() * (n - lag));
    return 1.0 - variogram / (2.0 * total);
  };
  double time = 1.0;
  for (std::size_t lag = 1; lag + 1 < n; lag += 2) {
    const double pair = correlation(lag) + correlation(lag + 1);
    if (pair < 0.0) break;
    time += 2.0 * pair;
  }
  return {std::sqrt(total / within), length * static_cast<double>(halves.size()) / time};
}

Posterior sample_posterior(const Outlook& outlook, const UnitPoint& best) {
  if (best.empty()) return {};
  std::vector<UnitPoint> first, second;
  for (UnitPoint& point : likely_points(outlook, best)) {
    (first.size() == second.size() ? first : second).push_back(std::move(point));
  }
  // Where the constraints leave next to nothing.
  if (second.size() < 2 * best.size() + 2) return {};
  first.resize(second.size());
  Ensemble one(outlook, std::move(first), 0);
  Ensemble other(outlook, std::move(second), 1);
  std::vector<std::vector<UnitPoint>> both;
  Posterior posterior;
  for (std::size_t steps = first_steps; steps <= most_steps; steps *= 2) {
    while (both.size() < steps) {
      std::vector<UnitPoint>& all = both.emplace_back(one.step());
      const std::vector<UnitPoint>& more = other.step();
      all.insert(all.end(), more.begin(), more.end());
    }
    posterior = summary(outlook.ledger.space(), both);
    if (posterior.r_hat <= 1.01 && posterior.effective_samples >= enough_samples) break;
  }
  return posterior;
}

}  // namespace repose::calibrator
