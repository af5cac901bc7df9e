#include "server/exports/dem_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "engine/catalogue.hpp"
#include "engine/material.hpp"
#include "engine/unit.hpp"
#include "server/json/place.hpp"

namespace repose::server {

using engine::make_key;
using engine::MaterialId;
using engine::ParameterSet;

namespace {

constexpr std::string_view restitution = "restitution.coefficient";
constexpr std::string_view friction = "sliding_friction.coefficient";
constexpr std::string_view constant_rolling = "rolling_resistance.coefficient";
constexpr std::string_view spring_rolling = "elastic_rolling_resistance.coefficient";
constexpr std::string_view cohesion = "area_cohesion.energy_density";
constexpr std::array said{restitution, friction, constant_rolling, spring_rolling, cohesion};

double property(const ParameterSet& set, std::string_view name, MaterialId of) {
  const std::string field = "material." + std::string(name);
  const double own = set.get_or(make_key(field, {MaterialId::grain}), 0.0);
  return of == MaterialId::grain ? own : set.get_or(make_key(field, {of}), own);
}

Stuff stuff(const ParameterSet& set, MaterialId of) {
  const double poisson = property(set, "poisson_ratio", of);
  return {2.0 * property(set, "shear_modulus", of) * (1.0 + poisson), poisson};
}

PairLaw pair_law(const ParameterSet& set, const Stuff& grain, const Stuff& other, MaterialId id) {
  const auto value = [&](std::string_view field, double null) {
    return set.get_or(make_key(field, {MaterialId::grain, id}), null);
  };
  const auto compliance = [](const Stuff& s) { return (1.0 - s.poisson * s.poisson) / s.young; };
  const auto shear_compliance = [](const Stuff& s) {
    return 2.0 * (2.0 - s.poisson) * (1.0 + s.poisson) / s.young;
  };
  return {.modulus = 1.0 / (compliance(grain) + compliance(other)),
          .shear = 1.0 / (shear_compliance(grain) + shear_compliance(other)),
          .restitution = value(restitution, 1.0),
          .friction = value(friction, 0.0),
          .rolling = std::max(value(constant_rolling, 0.0), value(spring_rolling, 0.0)),
          .cohesion = value(cohesion, 0.0)};
}

/// A fifth of the Rayleigh time, Li, Xu & Thornton 2005, Powder Technology 160, 219-228.
double time_step(const DemModel& model) {
  const double shear = model.grain.young / (2.0 * (1.0 + model.grain.poisson));
  const double pi = engine::unit::pi;
  return 0.2 * pi * 0.5 * model.diameter * std::sqrt(model.density / shear) /
         (0.1631 * model.grain.poisson + 0.8766);
}

}  // namespace

DemModel dem_model(const ParameterSet& set) {
  DemModel model;
  model.diameter = property(set, "diameter", MaterialId::grain);
  model.density = property(set, "density", MaterialId::grain);
  model.grain = stuff(set, MaterialId::grain);
  model.wall = stuff(set, MaterialId::wall);
  model.between_grains = pair_law(set, model.grain, model.grain, MaterialId::grain);
  model.at_wall = pair_law(set, model.grain, model.wall, MaterialId::wall);
  model.time_step = time_step(model);
  for (const auto& [key, value] : set) {
    if (key.field.starts_with("material.")) continue;
    const engine::ParameterInfo* info = engine::find_parameter(key.field);
    if (info != nullptr && value == info->field->null_value) continue;
    if (key.field == spring_rolling) model.rolling_spring = true;
    if (std::ranges::find(said, key.field) != said.end()) continue;
    model.unsaid.push_back(engine::to_string(key) + " = " + engine::short_number(value) + " (SI)");
  }
  return model;
}

}  // namespace repose::server
