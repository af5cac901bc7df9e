/// Velocity-dependent restitution: a viscous material beside the spring, so that faster collisions
/// give back less.
///
///   F <- max(0, F + 2 E* A a v),     T's dashpot <- T's dashpot + 8 G* A a
///
///   A  relaxation time of the material, s     a  radius of the contact patch, m
///   v  speed of approach, m/s
///
/// Each dashpot is A times the tangent stiffness of its spring. Alone on an elastic contact,
///
///   e = 1 - C1 s + (3/5) C1^2 s^2 - ...,   s = (3/2) A (K / m)^(2/5) v^(1/5),   C1 = 1.15344,
///
/// K = (4/3) E* sqrt(R*), m the reduced mass; a constant restitution beside it adds its own loss.
/// For a given A a stiffer or smaller grain loses more: a softened modulus asks for a longer A.
///
/// Source: Kuwabara & Kono 1987, Jpn. J. Appl. Phys. 26, 1230-1233; Brilliantov, Spahn, Hertzsch &
///         Poeschel 1996, Phys. Rev. E 53, 5382-5392 (the law); Ramirez, Poeschel, Brilliantov &
///         Schwager 1999, Phys. Rev. E 60, 4465-4472 (e of v).
/// Null:   A = 0: both dashpots are exactly zero.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct VelocityRestitution {
  struct Parameters {
    double relaxation;
  };
  struct Coefficients {
    double normal;   ///< 2 E* A, Pa s
    double tangent;  ///< 8 G* A, Pa s
  };

  static constexpr EffectText text{
      .name = "velocity_restitution",
      .title = "Velocity-dependent restitution",
      .summary =
          "Grains rebound less, the faster they meet: drop tests from several heights "
          "differ, slow flows hardly change.",
      .citation = "Ramirez et al. 1999, Phys. Rev. E 60, 4465-4472",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::relaxation,
                        {.name = "relaxation",
                         .unit = unit::millisecond,
                         .meaning = "dashpot over tangent stiffness of a contact",
                         .null_value = 0.0,
                         .lower = 0.0,
                         .upper = 1e-3}},
  };
  static constexpr Stage stage = Stage::dissipation;
  static constexpr Scope scope = Scope::pair;

  /// A collision at 1 m/s loses a quarter of its speed: C1 s = 1/4.
  static Parameters strong(const GrainScale& g) {
    const double spring = 4.0 / 3.0 * g.elastic.modulus * std::sqrt(0.5 * g.radius);
    return {0.25 / (1.15344 * 1.5 * std::pow(spring / (0.5 * g.mass()), 0.4))};
  }

  static constexpr int history_columns = 0;

  static Coefficients prepare(const Parameters& p, const PairElastic& pair) {
    return {2.0 * pair.modulus * p.relaxation, 8.0 * pair.shear_modulus * p.relaxation};
  }

  static void contact(ContactBlock& c, const Coefficients& k, HistoryBlock, double) {
    const double normal = k.normal, tangent = k.tangent;
    for (int i = 0; i < ContactBlock::width; ++i) {
      const double force = c.normal_force[i] + normal * c.patch_radius[i] * c.approach[i];
      c.normal_force[i] = force > 0.0 ? force : 0.0;
      c.grip_force[i] = c.normal_force[i];
      c.shear_damping[i] += tangent * c.patch_radius[i];
    }
  }
};

}  // namespace repose::engine::effects
