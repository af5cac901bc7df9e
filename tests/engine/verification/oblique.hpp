/// Oblique impact of a sphere on a rigid plane, integrated apart from the engine, so that what
/// other codes call Mindlin's spring can be told apart.
#pragma once

#include <cstdint>

namespace repose::tests {

/// k = `stiffness` * 8 G* a; the dashpot is `damping` of the engine's.
struct TangentialLaw {
  enum class Spring : std::uint8_t {
    displacement,  ///< T = -k s: force of the whole displacement (the engine's)
    increments,    ///< dT = -k ds: what was once loaded stays when a shrinks
  };
  Spring spring = Spring::displacement;
  double stiffness = 1.0;
  double damping = 1.0;
};

/// Overlap small beside the radius; spheres of 2/5 m R^2.
struct ObliqueImpact {
  double sliding;  ///< coefficient of friction
  double poisson;  ///< of the sphere
  double damping;  ///< number of the normal dashpot, effects/restitution
  double slip;     ///< tangential velocity of the sphere's surface over mu Vn
};

/// Slip after the impact over slip before.
double slip_ratio(const ObliqueImpact& impact, const TangentialLaw& law);

}  // namespace repose::tests
