#include "server/cli/reference_grain.hpp"

#include <array>

namespace repose::server {

engine::ParameterSet reference_grain() {
  using enum engine::MaterialId;
  using Between = std::vector<engine::MaterialId>;
  engine::ParameterSet set;
  set.set(engine::make_key("material.diameter", {grain}), 6.496e-3);  // m
  set.set(engine::make_key("material.density", {grain}), 1228.0);     // kg/m3
  for (const engine::MaterialId material : {grain, wall}) {
    set.set(engine::make_key("material.poisson_ratio", {material}), 0.25);
    set.set(engine::make_key("material.shear_modulus", {material}), 1.04e6);  // Pa
  }
  for (const Between& pair : std::array{Between{grain, grain}, Between{grain, wall}}) {
    set.set(engine::make_key("restitution.coefficient", pair), 0.6);
    set.set(engine::make_key("rolling_resistance.coefficient", pair), 0.05);
  }
  set.set(engine::make_key("sliding_friction.coefficient", {grain, grain}), 0.45);
  set.set(engine::make_key("sliding_friction.coefficient", {grain, wall}), 0.30);
  return set;
}

}  // namespace repose::server
