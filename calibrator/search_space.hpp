/// SearchSpace: the unit cube in which the optimiser works, mapped to and from complete
/// ParameterSets.
///
///   linear   x = lower + u (upper - lower)
///   log      x = lower (upper / lower)^u        0 <= u <= 1, x in SI
///   tied     value(key) = factor * value(to),   `to` being free or fixed
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "calibrator/calibration.hpp"

namespace repose::calibrator {

/// A point of the unit cube, in the order of the free parameters.
using UnitPoint = std::vector<double>;

class SearchSpace {
 public:
  explicit SearchSpace(const Calibration& calibration);

  [[nodiscard]] std::size_t dimensions() const { return free_.size(); }

  /// Fixed, free and tied parameters together.
  [[nodiscard]] engine::ParameterSet at(std::span<const double> point) const;

  /// Where a set lies in the cube; outside the bounds it is clipped to them.
  [[nodiscard]] UnitPoint coordinates(const engine::ParameterSet& parameters) const;

  /// The value of one free parameter at its coordinate, and back. SI.
  [[nodiscard]] double value(std::size_t parameter, double coordinate) const;
  [[nodiscard]] double coordinate(std::size_t parameter, double value) const;

 private:
  engine::ParameterSet fixed_;
  std::vector<FreeParameter> free_;
  std::vector<Tie> tied_;
};

/// Euclidean distance in the cube.
double distance(std::span<const double> a, std::span<const double> b);

}  // namespace repose::calibrator
