#include "calibrator/search_space.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace repose::calibrator {

SearchSpace::SearchSpace(const Calibration& calibration)
    : fixed_(calibration.fixed), free_(calibration.free), tied_(calibration.tied) {
  for (const Constraint& constraint : calibration.constraints) {
    Relation relation{std::vector<double>(free_.size(), 0.0), constraint.bound, 0.0};
    for (const Constraint::Term& term : constraint.terms) {
      const auto tie = std::ranges::find(tied_, term.key, &Tie::key);
      const engine::ParameterKey& key = tie == tied_.end() ? term.key : tie->to;
      const double weight = term.coefficient * (tie == tied_.end() ? 1.0 : tie->factor);
      const auto found = std::ranges::find(free_, key, &FreeParameter::key);
      if (found == free_.end()) {
        relation.bound -= weight * fixed_.get_or(key, 0.0);
      } else {
        relation.weights[static_cast<std::size_t>(found - free_.begin())] += weight;
      }
    }
    for (std::size_t k = 0; k < free_.size(); ++k) {
      relation.range += std::abs(relation.weights[k]) * (free_[k].upper - free_[k].lower);
    }
    if (relation.range == 0.0) relation.range = 1.0;  // nothing free is in it
    relations_.push_back(std::move(relation));
  }
}

double SearchSpace::value(std::size_t parameter, double coordinate) const {
  const FreeParameter& p = free_[parameter];
  const double u = std::clamp(coordinate, 0.0, 1.0);
  // The ends are met exactly, so that a bound is never overstepped by a rounding error.
  if (u == 0.0) return p.lower;
  if (u == 1.0) return p.upper;
  if (p.scale == Scale::log) return p.lower * std::pow(p.upper / p.lower, u);
  return p.lower + u * (p.upper - p.lower);
}

double SearchSpace::coordinate(std::size_t parameter, double value) const {
  const FreeParameter& p = free_[parameter];
  const double x = std::clamp(value, p.lower, p.upper);
  if (p.scale == Scale::log) return std::log(x / p.lower) / std::log(p.upper / p.lower);
  return (x - p.lower) / (p.upper - p.lower);
}

double SearchSpace::excess(const Relation& relation, std::span<const double> point) const {
  double sum = -relation.bound;
  for (std::size_t k = 0; k < free_.size(); ++k) {
    if (relation.weights[k] != 0.0) sum += relation.weights[k] * value(k, point[k]);
  }
  return sum / relation.range;
}

bool SearchSpace::allows(std::span<const double> point) const {
  return std::ranges::all_of(relations_,
                             [&](const Relation& r) { return excess(r, point) <= 0.0; });
}

Box SearchSpace::box() const {
  Box box = unit_box(free_.size());
  for (const Relation& relation : relations_) {
    box.excesses.emplace_back(
        [this, &relation](std::span<const double> point) { return excess(relation, point); });
  }
  return box;
}

double SearchSpace::slope(std::size_t parameter, double coordinate) const {
  const FreeParameter& p = free_[parameter];
  if (p.scale == Scale::log) return value(parameter, coordinate) * std::log(p.upper / p.lower);
  return p.upper - p.lower;
}

double SearchSpace::prior_misfit(std::span<const double> point) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < free_.size(); ++k) {
    if (!free_[k].prior) continue;
    const double z = (value(k, point[k]) - free_[k].prior->mean) / free_[k].prior->deviation;
    sum += z * z;
  }
  return sum;
}

double SearchSpace::log_prior(std::span<const double> point) const {
  double sum = -0.5 * prior_misfit(point);
  for (std::size_t k = 0; k < free_.size(); ++k) {
    if (free_[k].prior) sum += std::log(slope(k, point[k]));  // a density in x, carried over to u
  }
  return sum;
}

engine::ParameterSet SearchSpace::at(std::span<const double> point) const {
  assert(point.size() == free_.size());
  engine::ParameterSet parameters = fixed_;
  for (std::size_t k = 0; k < free_.size(); ++k) parameters.set(free_[k].key, value(k, point[k]));
  for (const Tie& tie : tied_) {
    if (const auto to = parameters.get(tie.to)) parameters.set(tie.key, tie.factor * *to);
  }
  return parameters;
}

UnitPoint SearchSpace::coordinates(const engine::ParameterSet& parameters) const {
  UnitPoint point(free_.size());
  for (std::size_t k = 0; k < free_.size(); ++k) {
    point[k] = coordinate(k, parameters.get_or(free_[k].key, free_[k].lower));
  }
  return point;
}

double distance(std::span<const double> a, std::span<const double> b) {
  assert(a.size() == b.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum);
}

}  // namespace repose::calibrator
