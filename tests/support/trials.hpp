/// Trials of the reference grain, small and large, and what they gave.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include <catch2/catch.hpp>

#include "engine/evaluate.hpp"
#include "tests/support/reference_grain.hpp"

namespace repose::tests {

inline engine::Trial trial_of(std::string_view experiment,
                              engine::Fidelity fidelity = engine::Fidelity::draft) {
  return {reference_grain(), {std::string(experiment), fidelity, {}}, 1};
}

/// The smallest apparatus that each experiment accepts, for tests of the machinery.
inline std::map<std::string, double> small_settings(std::string_view experiment) {
  if (experiment == "kettle") return {{"diameter", 0.034}, {"height", 0.034}, {"opening", 0.02}};
  if (experiment == "tilting_box") return {{"length", 0.08}, {"width", 0.0275}, {"depth", 0.02}};
  if (experiment == "heap")
    return {{"disc_diameter", 0.066}, {"cylinder_diameter", 0.038}, {"fill", 0.07}};
  if (experiment == "draw_down")
    return {{"length", 0.13}, {"width", 0.0275}, {"depth", 0.04}, {"slot", 0.03}};
  if (experiment == "drum") return {{"diameter", 0.07}, {"length", 0.02}, {"seconds", 0.3}};
  if (experiment == "compression")
    return {{"side", 0.033}, {"depth", 0.033}, {"stress", 5e3}, {"speed", 0.02}};
  return {};
}

/// Sliding friction and rolling resistance of grains with grains and walls alike.
inline void set_friction(engine::Trial& trial, double sliding, double rolling) {
  using engine::MaterialId;
  for (const MaterialId partner : {MaterialId::grain, MaterialId::wall}) {
    trial.parameters.set({"sliding_friction.coefficient", {MaterialId::grain, partner}}, sliding);
    trial.parameters.set({"rolling_resistance.coefficient", {MaterialId::grain, partner}}, rolling);
  }
}

inline engine::Failure failure_in(const engine::Evaluation& evaluation) {
  const auto* failure = std::get_if<engine::Failure>(&evaluation.outcome);
  REQUIRE(failure != nullptr);
  INFO(failure->message);
  return *failure;
}

inline double value_in(const engine::Evaluation& evaluation, std::size_t observable) {
  if (const auto* failure = std::get_if<engine::Failure>(&evaluation.outcome)) {
    FAIL(failure->message);
  }
  return std::get<std::vector<engine::Observation>>(evaluation.outcome)[observable].value;
}

inline double mean_of_seeds(engine::Trial trial, std::size_t observable, std::uint64_t seeds) {
  double sum = 0.0;
  for (trial.seed = 1; trial.seed <= seeds; ++trial.seed) {
    sum += value_in(evaluate(trial), observable);
  }
  return sum / static_cast<double>(seeds);
}

}  // namespace repose::tests
