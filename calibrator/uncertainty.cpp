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

double weighted_misfit(const Outlook& outlook, std::span<const double> point) {
  double sum = outlook.ledger.space().prior_misfit(point);
  for (const Target& target : outlook.targets) {
    const Belief belief = outlook.surrogate.at(target.measurement, point);
    const double gap = belief.mean - target.value;
    sum += gap * gap / (belief.variance + target.variance);
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
      return {start, allowed ? weighted_misfit(outlook_, start) : forbidden};
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
      return weighted_misfit(outlook_, complete(point));
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

/// The profile of one parameter on a grid of `steps` intervals, swept outwards from the best point.
std::vector<double> sweep(const Profile& profile, const UnitPoint& best, std::size_t parameter) {
  std::vector<double> values(steps + 1);
  const int middle = static_cast<int>(std::lround(best[parameter] * steps));
  UnitPoint from = best;
  for (int i = middle; i <= steps; ++i) {
    Minimum found = profile.at(static_cast<double>(i) / steps, from);
    values[static_cast<std::size_t>(i)] = found.value;
    from = std::move(found.at);
  }
  from = best;
  for (int i = middle - 1; i >= 0; --i) {
    Minimum found = profile.at(static_cast<double>(i) / steps, from);
    values[static_cast<std::size_t>(i)] = found.value;
    from = std::move(found.at);
  }
  return values;
}

/// The hull of where the profile is below the limit; `best` is inside whatever the grid says.
Interval hull(const std::vector<double>& profile, double best, double best_value, double limit) {
  // Where the line between two neighbours meets the limit; `inside` is the one below it.
  const auto crossing = [&](double inside, double value, double outside, double other) {
    return inside + (outside - inside) * std::clamp((limit - value) / (other - value), 0.0, 1.0);
  };
  const auto at = [](std::size_t i) { return static_cast<double>(i) / steps; };
  Interval interval{best, best, false, false};
  const auto below = [&](double value) { return value <= limit; };
  const auto first = std::ranges::find_if(profile, below);
  if (first == profile.end()) {  // narrower than the grid: the neighbours of the best bound it
    const auto right = std::min(static_cast<std::size_t>(best * steps) + 1, profile.size() - 1);
    const std::size_t left = right - 1;
    interval.lower = crossing(best, best_value, at(left), profile[left]);
    interval.upper = crossing(best, best_value, at(right), profile[right]);
    return interval;
  }
  const auto low = static_cast<std::size_t>(first - profile.begin());
  auto high = profile.size() - 1;
  while (!below(profile[high])) --high;
  interval.lower_at_bound = low == 0;
  interval.upper_at_bound = high == profile.size() - 1;
  interval.lower = low == 0 ? 0.0 : crossing(at(low), profile[low], at(low - 1), profile[low - 1]);
  interval.upper = interval.upper_at_bound
                       ? 1.0
                       : crossing(at(high), profile[high], at(high + 1), profile[high + 1]);
  interval.lower = std::min(interval.lower, best);
  interval.upper = std::max(interval.upper, best);
  return interval;
}

}  // namespace

std::vector<Interval> profile_intervals(const Outlook& outlook, const UnitPoint& best) {
  const std::size_t d = best.size();
  const std::uint64_t seed = outlook.ledger.calibration().seed;
  std::vector<Minimum> candidates;
  for (UnitPoint& point : allowed_points(outlook.ledger.space(), 1000, seed, candidate_design)) {
    const double value = weighted_misfit(outlook, point);
    candidates.push_back({std::move(point), value});
  }
  std::vector<std::vector<double>> profiles;
  const double best_value = weighted_misfit(outlook, best);
  double smallest = best_value;
  for (std::size_t k = 0; k < d; ++k) {
    profiles.push_back(sweep(Profile(outlook, k, candidates), best, k));
    smallest = std::min(smallest, std::ranges::min(profiles.back()));
  }
  std::vector<Interval> intervals;
  for (std::size_t k = 0; k < d; ++k) {
    intervals.push_back(hull(profiles[k], best[k], best_value, smallest + threshold));
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
