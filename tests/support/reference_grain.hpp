/// The reference grain of cross-code comparison, and small worlds made of it.
#pragma once

#include "engine/parameter_set.hpp"
#include "engine/world.hpp"

namespace repose::tests {

struct GrainLaw {
  double shear_modulus = 1.04e6;  // Pa
  double poisson_ratio = 0.25;
  double density = 1228.0;     // kg/m3
  double diameter = 6.496e-3;  // m
  double restitution = 1.0;
  double sliding = 0.0;
  double rolling = 0.0;
  double elastic_rolling = 0.0;
  double own_spin_rolling = 0.0;
  double wall_stiffening = 1.0;  // shear modulus of the wall over the grain's
};

inline engine::ParameterSet parameters(const GrainLaw& law) {
  using engine::MaterialId;
  engine::ParameterSet set;
  set.set({"material.density", {MaterialId::grain}}, law.density);
  set.set({"material.diameter", {MaterialId::grain}}, law.diameter);
  set.set({"material.shear_modulus", {MaterialId::grain}}, law.shear_modulus);
  set.set({"material.shear_modulus", {MaterialId::wall}}, law.shear_modulus * law.wall_stiffening);
  for (const MaterialId partner : {MaterialId::grain, MaterialId::wall}) {
    set.set({"material.poisson_ratio", {partner}}, law.poisson_ratio);
    set.set({"restitution.coefficient", {MaterialId::grain, partner}}, law.restitution);
    set.set({"sliding_friction.coefficient", {MaterialId::grain, partner}}, law.sliding);
    set.set({"rolling_resistance.coefficient", {MaterialId::grain, partner}}, law.rolling);
    set.set({"elastic_rolling_resistance.coefficient", {MaterialId::grain, partner}},
            law.elastic_rolling);
    set.set({"own_spin_rolling_resistance.coefficient", {MaterialId::grain, partner}},
            law.own_spin_rolling);
  }
  return set;
}

/// The soybean of the cross-code comparison.
inline engine::ParameterSet reference_grain() {
  engine::ParameterSet set = parameters({.restitution = 0.6, .sliding = 0.45, .rolling = 0.05});
  set.set({"sliding_friction.coefficient", {engine::MaterialId::grain, engine::MaterialId::wall}},
          0.30);
  return set;
}

/// A world without gravity.
inline engine::World weightless(const GrainLaw& law, double time_step) {
  return engine::World(engine::ContactModel(parameters(law)),
                       {.time_step = time_step, .period = {}, .gravity = {}});
}

}  // namespace repose::tests
