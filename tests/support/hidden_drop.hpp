/// A study of drops whose data our own engine made with an effect that the study's model lacks:
/// restitution that falls with speed. Drops cost next to nothing.
#pragma once

#include <string>
#include <vector>

#include "engine/evaluate.hpp"
#include "engine/parameter_set.hpp"

namespace repose::tests {

/// Of a grain on a steel wall with that relaxation time (s), dropped from that height (m).
inline double dropped(double height, double relaxation) {
  using enum engine::MaterialId;
  engine::ParameterSet set;
  set.set({"material.density", {grain}}, 1228.0);
  set.set({"material.diameter", {grain}}, 6.496e-3);
  set.set({"material.shear_modulus", {grain}}, 1.04e6);
  set.set({"material.poisson_ratio", {grain}}, 0.25);
  set.set({"material.shear_modulus", {wall}}, 8e10);
  set.set({"material.poisson_ratio", {wall}}, 0.3);
  set.set({"restitution.coefficient", {grain, wall}}, 0.8);
  set.set({"velocity_restitution.relaxation", {grain, wall}}, relaxation);
  const engine::Evaluation evaluation = engine::evaluate(
      {.parameters = set,
       .experiment = {
           .name = "drop", .fidelity = engine::Fidelity::draft, .settings = {{"height", height}}}});
  return std::get<std::vector<engine::Observation>>(evaluation.outcome).front().value;
}

/// The study document. One measurement in four is held out. `suspects`: a JSON list; empty: the
/// whole catalogue.
inline std::string hidden_drop_study(double relaxation,
                                     const std::string& suspects = R"(["velocity_restitution"])") {
  std::string measurements;
  int index = 0;
  for (const double height : {0.004, 0.008, 0.016, 0.032, 0.064, 0.128}) {
    measurements += std::string(index == 0 ? "" : ",") +
                    R"({"experiment":"drop","observable":"restitution","unit":"1",)" +
                    R"("standard_error":0.003,"value":)" +
                    std::to_string(dropped(height, relaxation)) +
                    R"(,"settings":{"height":{"value":)" + std::to_string(height) +
                    R"(,"unit":"m"}},"role":")" + (index % 4 == 2 ? "held_out" : "fit") + R"("})";
    ++index;
  }
  return R"({"name":"drops from six heights","materials":{"grain":{)"
         R"("density":{"value":1228,"unit":"kg/m3"},"diameter":{"value":6.496,"unit":"mm"},)"
         R"("shear_modulus":{"value":1.04,"unit":"MPa"},"poisson_ratio":{"value":0.25,"unit":"1"}},)"
         R"("wall":{"shear_modulus":{"value":80,"unit":"GPa"},)"
         R"("poisson_ratio":{"value":0.3,"unit":"1"}}},)"
         R"("free":[{"field":"restitution.coefficient","between":["grain","wall"],)"
         R"("lower":0.3,"upper":0.95,"unit":"1"}],)"
         R"("measurements":[)" +
         measurements + R"(],"suspects":)" + suspects +
         R"(,)"
         R"("budget":{"evaluations":12,"batch":2,"fidelity":"draft"},"seed":1})";
}

}  // namespace repose::tests
