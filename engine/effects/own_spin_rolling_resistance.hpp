/// Own-spin rolling resistance: a torque of constant size on each grain against its own spin.
///
///   T_i = -mu_r R_i F w_i / |w_i|,   T_j likewise
///
///   w_i  spin of the grain itself, rad/s     R_i  from its centre to the contact point, m
///   F    normal force that friction leans on, N
///
/// The cap has the grain's own radius; the two laws on relative rolling have the reduced radius.
/// Between equal grains this mu_r is as strong as twice the value there, at a wall as the same.
/// The two torques are not opposite: grains that spin alike as one body are braked all the same,
/// so the angular momentum of a pair is not kept. Offered since published coefficients are often
/// those of this form. The torques keep their size at the slightest spin, and a grain has one at
/// each of its contacts: a bed trembles, the more the larger mu_r, and above about 0.1 it may never
/// meet the threshold of rest.
///
/// Source: Sakaguchi, Ozaki & Igarashi 1993, Int. J. Mod. Phys. B 7, 1949-1963; Ai, Chen, Rotter &
///         Ooi 2011, Powder Technology 206, 269-282 (model A, on which spin it may act).
/// Null:   mu_r = 0: the torques are exactly zero.
#pragma once

#include <array>
#include <cmath>

#include "engine/effect.hpp"

namespace repose::engine::effects {

struct OwnSpinRollingResistance {
  struct Parameters {
    double coefficient;
  };
  using Coefficients = Parameters;

  static constexpr EffectText text{
      .name = "own_spin_rolling_resistance",
      .title = "Own-spin rolling resistance",
      .summary = "Every contact brakes a grain's own spin, whatever the spin of its neighbour.",
      .citation = "Sakaguchi et al. 1993, Int. J. Mod. Phys. B 7, 1949-1963",
      .family = "rolling",
  };
  static constexpr std::array fields{
      Field<Parameters>{&Parameters::coefficient,
                        {.name = "coefficient",
                         .unit = unit::one,
                         .meaning = "torque over (distance from centre to contact x normal force)",
                         .null_value = 0.0,
                         .lower = 0.0,
                         .upper = 1.0}},
  };
  static constexpr Stage stage = Stage::rolling;
  static constexpr Scope scope = Scope::pair;

  static Coefficients prepare(const Parameters& p, const PairElastic&) { return p; }

  static void load(ContactBlock& c, const Coefficients& p) {
    brake(c.i, c.arm_i, c.grip_force, p.coefficient, c.torque_i);
    brake(c.j, c.arm_j, c.grip_force, p.coefficient, c.torque_j);
  }

 private:
  [[gnu::always_inline]] static inline void brake(const ContactBlock::End& end,
                                                  const ContactBlock::Column& arm,
                                                  const ContactBlock::Column& force,
                                                  double mu,
                                                  ContactBlock::Vector& torque) {
    for (int i = 0; i < ContactBlock::width; ++i) {
      const double wx = end.wx[i], wy = end.wy[i], wz = end.wz[i];
      const double w = std::sqrt(wx * wx + wy * wy + wz * wz);
      const double size = w > 0.0 ? mu * arm[i] * force[i] / w : 0.0;
      torque.x[i] -= size * wx;
      torque.y[i] -= size * wy;
      torque.z[i] -= size * wz;
    }
  }
};

}  // namespace repose::engine::effects
