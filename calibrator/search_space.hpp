/// SearchSpace: the unit cube in which the optimiser works, mapped to and from complete
/// ParameterSets.
///
///   linear   x = lower + u (upper - lower)
///   log      x = lower (upper / lower)^u        0 <= u <= 1, x in SI
///   tied     value(key) = factor * value(to),   `to` being free or fixed
///
/// A constraint, sum_k a_k x_k <= b once ties and fixed values are put in, is an excess of at most
/// 0 in units of what its sum can range over. A parameter is as likely everywhere in [0, 1] unless
/// it has a prior: then it is normal in x, cut off at the bounds.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/optimiser.hpp"

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

  /// Whether all constraints are kept.
  [[nodiscard]] bool allows(std::span<const double> point) const;
  /// The cube, less what the constraints forbid.
  [[nodiscard]] Box box() const;

  /// d value / d coordinate, SI.
  [[nodiscard]] double slope(std::size_t parameter, double coordinate) const;
  /// sum ((x - mean) / deviation)^2 over the parameters with a prior.
  [[nodiscard]] double prior_misfit(std::span<const double> point) const;
  /// Logarithm of the prior's density in the cube, but for a constant.
  [[nodiscard]] double log_prior(std::span<const double> point) const;

 private:
  /// sum_k weights_k x_k - bound, over the range of the sum; at most 0 where it is kept.
  struct Relation {
    std::vector<double> weights;
    double bound = 0.0;
    double range = 1.0;
  };
  [[nodiscard]] double excess(const Relation& relation, std::span<const double> point) const;

  engine::ParameterSet fixed_;
  std::vector<FreeParameter> free_;
  std::vector<Tie> tied_;
  std::vector<Relation> relations_;
};

/// Euclidean distance in the cube.
double distance(std::span<const double> a, std::span<const double> b);

}  // namespace repose::calibrator
