#include "calibrator/uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Eigenvalues>

#include "calibrator/design.hpp"
#include "calibrator/optimiser.hpp"

namespace repose::calibrator {
namespace {

using Eigen::Index;

constexpr double uniform_precision = 12.0;
constexpr double threshold = 3.841458820694124;  // 95 % of chi-squared with one degree of freedom
constexpr double forbidden = std::numeric_limits<double>::infinity();  // by a constraint
constexpr int steps = 40;                                              // grid of a profile
constexpr std::uint64_t candidate_design = 2'000'000;

/// Twice, with the priors': Q.
double minus_log_likelihood(const Outlook& outlook, std::span<const double> point) {
  double sum = outlook.ledger.space().prior_misfit(point);
  for (const Target& target : outlook.targets) {
    const Belief belief = outlook.surrogate.at(target.measurement, point);
    const double gap = belief.mean - target.value;
    const double variance = belief.variance + target.variance;
    sum += gap * gap / variance + std::log(variance);
  }
  return sum;
}

/// PL_k on a grid, each point started from its neighbour's solution and from the best candidate
/// near.
class Profile {
 public:
  Profile(const Outlook& outlook, std::size_t parameter, std::span<const Minimum> candidates)
      : outlook_(outlook), parameter_(parameter), candidates_(candidates) {}

  /// The minimum with the parameter held.
  [[nodiscard]] Minimum at(double held, UnitPoint start) const {
    start[parameter_] = held;
    if (start.size() == 1) {
      const bool allowed = outlook_.ledger.space().allows(start);
      return {start, allowed ? minus_log_likelihood(outlook_, start) : forbidden};
    }
    Minimum best = search(start);
    const UnitPoint other = candidate(held);
    if (!other.empty()) {
      Minimum found = search(other);
      if (found.value < best.value) best = std::move(found);
    }
    return best;
  }

 private:
  [[nodiscard]] Minimum search(UnitPoint start) const {
    const double held = start[parameter_];
    UnitPoint rest = start;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(parameter_));
    UnitPoint whole;
    const auto complete = [&](std::span<const double> point) -> const UnitPoint& {
      whole.assign(point.begin(), point.end());
      whole.insert(whole.begin() + static_cast<std::ptrdiff_t>(parameter_), held);
      return whole;
    };
    const Objective objective = [&](std::span<const double> point) {
      return minus_log_likelihood(outlook_, complete(point));
    };
    const Box cube = outlook_.ledger.space().box();
    Box box = unit_box(rest.size());
    for (const Objective& excess : cube.excesses) {
      box.excesses.emplace_back(
          [&](std::span<const double> point) { return excess(complete(point)); });
    }
    Minimum found = minimise_locally(
        objective,
        box,
        rest,
        {.evaluations = 20 + 10 * static_cast<int>(rest.size()), .tolerance = 1e-3});
    found.at.insert(found.at.begin() + static_cast<std::ptrdiff_t>(parameter_), held);
    return found;
  }

  [[nodiscard]] UnitPoint candidate(double held) const {
    double smallest = std::numeric_limits<double>::infinity();
    UnitPoint best;
    for (const Minimum& candidate : candidates_) {
      if (std::abs(candidate.at[parameter_] - held) > 0.05 || candidate.value >= smallest) continue;
      smallest = candidate.value;
      best = candidate.at;
    }
    if (!best.empty()) best[parameter_] = held;
    return best;
  }

  const Outlook& outlook_;
  std::size_t parameter_;
  std::span<const Minimum> candidates_;
};

/// The profile of one parameter: at the best point and outwards from it on a grid of `steps`
/// intervals, by rising coordinate.
struct Sweep {
  std::vector<Minimum> nodes;
  std::size_t middle = 0;  ///< the best point's
};

Sweep sweep(const Profile& profile, const UnitPoint& best, std::size_t parameter) {
  const auto walk = [&](int from, int to, int step, UnitPoint start) {
    std::vector<Minimum> found;
    for (int i = from; i != to; i += step) {
      found.push_back(profile.at(static_cast<double>(i) / steps, std::move(start)));
      start = found.back().at;
    }
    return found;
  };
  const double at = best[parameter] * steps;
  Minimum middle = profile.at(best[parameter], best);
  const std::vector<Minimum> right =
      walk(static_cast<int>(std::floor(at)) + 1, steps + 1, 1, middle.at);
  Sweep result{walk(static_cast<int>(std::ceil(at)) - 1, -1, -1, middle.at), 0};
  result.middle = result.nodes.size();
  std::ranges::reverse(result.nodes);
  result.nodes.push_back(std::move(middle));
  result.nodes.insert(result.nodes.end(), right.begin(), right.end());
  return result;
}

struct End {
  double at = 0.0;
  bool at_bound = false;
};

/// Where the profile passes `smallest` + threshold, between a node within and the next one beyond.
/// The root of its rise is nearly straight, so that a guess on it needs few corrections. What a
/// constraint forbids is halved; where that is the end, the data did not set it.
End crossing(const Profile& profile,
             std::size_t parameter,
             Minimum within,
             Minimum beyond,
             double smallest) {
  constexpr int corrections = 6;
  constexpr double close = 0.02;  // of Q
  const auto root = [&](const Minimum& node) {
    return std::sqrt(std::max(0.0, node.value - smallest));
  };
  const auto guess = [&] {
    const double share = std::isinf(beyond.value) ? 0.5
                                                  : (std::sqrt(threshold) - root(within)) /
                                                        (root(beyond) - root(within));
    return std::lerp(within.at[parameter], beyond.at[parameter], std::clamp(share, 0.05, 0.95));
  };
  for (int i = 0; i < corrections; ++i) {
    Minimum found = profile.at(guess(), within.at);
    const double excess = found.value - smallest - threshold;
    if (std::abs(excess) < close) return {found.at[parameter], false};
    (excess < 0.0 ? within : beyond) = std::move(found);
  }
  if (std::isinf(beyond.value)) return {within.at[parameter], true};
  return {guess(), false};
}

/// The hull of where the profile is below the limit; the best point is inside whatever it says.
Interval hull(const Profile& profile, std::size_t parameter, const Sweep& sweep, double smallest) {
  const auto& nodes = sweep.nodes;
  const auto below = [&](const Minimum& node) { return node.value <= smallest + threshold; };
  std::size_t low = 0, high = nodes.size() - 1;
  while (low < sweep.middle && !below(nodes[low])) ++low;
  while (high > sweep.middle && !below(nodes[high])) --high;
  const auto end = [&](std::size_t last, bool outermost, std::size_t next) {
    if (outermost) return End{nodes[last].at[parameter], true};
    return crossing(profile, parameter, nodes[last], nodes[next], smallest);
  };
  const End lower = end(low, low == 0, low - 1);
  const End upper = end(high, high == nodes.size() - 1, high + 1);
  return {lower.at, upper.at, lower.at_bound, upper.at_bound};
}

}  // namespace

std::vector<Interval> profile_intervals(const Outlook& outlook, const UnitPoint& best) {
  const std::size_t d = best.size();
  const std::uint64_t seed = outlook.ledger.calibration().seed;
  std::vector<Minimum> candidates;
  for (UnitPoint& point : allowed_points(outlook.ledger.space(), 1000, seed, candidate_design)) {
    const double value = minus_log_likelihood(outlook, point);
    candidates.push_back({std::move(point), value});
  }
  std::vector<Profile> profiles;
  std::vector<Sweep> sweeps;
  double smallest = minus_log_likelihood(outlook, best);
  for (std::size_t k = 0; k < d; ++k) {
    profiles.emplace_back(outlook, k, candidates);
    sweeps.push_back(sweep(profiles.back(), best, k));
    for (const Minimum& node : sweeps.back().nodes) smallest = std::min(smallest, node.value);
  }
  std::vector<Interval> intervals;
  for (std::size_t k = 0; k < d; ++k) {
    intervals.push_back(hull(profiles[k], k, sweeps[k], smallest));
  }
  return intervals;
}

Eigen::VectorXd prior_precision(const Outlook& outlook, const UnitPoint& best) {
  const SearchSpace& space = outlook.ledger.space();
  const auto& free = outlook.ledger.calibration().free;
  Eigen::VectorXd precision(static_cast<Index>(best.size()));
  for (std::size_t k = 0; k < best.size(); ++k) {
    const double slope = space.slope(k, best[k]);
    const double own = free[k].prior ? slope / free[k].prior->deviation : 0.0;
    precision(static_cast<Index>(k)) = uniform_precision + own * own;
  }
  return precision;
}

Eigen::MatrixXd information(const Outlook& outlook, const UnitPoint& best) {
  const auto d = static_cast<Index>(best.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(d, d);
  for (const Target& target : outlook.targets) {
    const auto& process = outlook.surrogate.process(target.measurement);
    const Eigen::VectorXd slope = process->gradient(best);
    sum += slope * slope.transpose() / (process->at(best).variance + target.variance);
  }
  return sum;
}

namespace {

/// As a product of powers: along it du_k = (x_k / slope_k) d log x_k.
void write_as_product(const SearchSpace& space,
                      const UnitPoint& best,
                      double deviation,
                      Direction& direction) {
  double largest = 0.0;
  for (std::size_t k = 0; k < best.size(); ++k) {
    const double power =
        direction.components[k] * space.value(k, best[k]) / space.slope(k, best[k]);
    if (std::abs(power) > std::abs(largest)) largest = power;
    direction.powers.push_back(power);
  }
  if (largest == 0.0) return;
  for (double& power : direction.powers) power /= std::abs(largest);
  direction.product_error = deviation / std::abs(largest);
}

}  // namespace

Learnt learnt_directions(const Outlook& outlook, const UnitPoint& best) {
  const auto d = static_cast<Index>(best.size());
  Learnt result;
  if (d == 0) return result;
  const Eigen::VectorXd prior = prior_precision(outlook, best);
  const Eigen::MatrixXd data = information(outlook, best);
  const Eigen::MatrixXd precision = data + Eigen::MatrixXd(prior.asDiagonal());
  const Eigen::VectorXd posterior = precision.inverse().diagonal();
  for (Index k = 0; k < d; ++k) result.share.push_back(1.0 - prior(k) * posterior(k));

  // In coordinates in which the prior is a unit sphere.
  const Eigen::VectorXd scale = prior.cwiseSqrt();
  const Eigen::MatrixXd relative =
      scale.cwiseInverse().asDiagonal() * data * scale.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(relative);
  for (Index i = d - 1; i >= 0; --i) {  // the solver sorts upwards
    Eigen::VectorXd vector = scale.cwiseProduct(solver.eigenvectors().col(i));
    const double length = vector.norm();
    vector /= length;
    Index largest = 0;
    vector.cwiseAbs().maxCoeff(&largest);
    if (vector(largest) < 0.0) vector = -vector;  // of the two signs, the one people read easily
    Direction direction;
    direction.components.assign(vector.data(), vector.data() + d);
    direction.posterior_to_prior = 1.0 / std::sqrt(1.0 + std::max(solver.eigenvalues()(i), 0.0));
    direction.learnt = direction.posterior_to_prior <= 0.5;
    write_as_product(
        outlook.ledger.space(), best, direction.posterior_to_prior / length, direction);
    result.directions.push_back(std::move(direction));
  }
  return result;
}

}  // namespace repose::calibrator
