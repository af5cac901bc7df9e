/// DemModel: a fit as the numbers that other codes ask for, and what of it they cannot say.
#pragma once

#include <string>
#include <vector>

#include "engine/parameter_set.hpp"

namespace repose::server {

/// What touches what, in this engine's conventions (engine/effects/).
struct PairLaw {
  double modulus = 0.0;      ///< E*, Pa: 1/E* = (1 - nu_i^2)/E_i + (1 - nu_j^2)/E_j
  double shear = 0.0;        ///< G*, Pa: 1/G* = (2 - nu_i)/G_i + (2 - nu_j)/G_j
  double restitution = 1.0;  ///< 1
  double friction = 0.0;     ///< 1
  double rolling = 0.0;      ///< couple over reduced radius and force, 1
  double cohesion = 0.0;     ///< energy over the area of contact, J/m3
};

struct Stuff {
  double young = 0.0;    ///< Pa
  double poisson = 0.0;  ///< 1
};

struct DemModel {
  double diameter = 0.0;  ///< m
  double density = 0.0;   ///< kg/m3
  Stuff grain, wall;
  PairLaw between_grains, at_wall;
  bool rolling_spring = false;  ///< the couple winds up like a spring; else it is constant
  double time_step = 0.0;       ///< s; a fifth of the Rayleigh time
  /// Parameters that are away from null and stand in none of the above: "effect.parameter = value".
  std::vector<std::string> unsaid;
};

/// Wall properties that the set does not have are the grain's.
DemModel dem_model(const engine::ParameterSet& set);

}  // namespace repose::server
