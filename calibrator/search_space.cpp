#include "calibrator/search_space.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace repose::calibrator {

SearchSpace::SearchSpace(const Calibration& calibration)
    : fixed_(calibration.fixed), free_(calibration.free), tied_(calibration.tied) {}

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
