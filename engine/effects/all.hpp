/// Every effect there is, in the order a step applies them. To add one: its file, its line here.
#pragma once

#include <tuple>

#include "engine/effects/area_cohesion.hpp"
#include "engine/effects/elastic_rolling_resistance.hpp"
#include "engine/effects/grain_shape.hpp"
#include "engine/effects/log_normal_sizes.hpp"
#include "engine/effects/own_spin_rolling_resistance.hpp"
#include "engine/effects/restitution.hpp"
#include "engine/effects/rolling_resistance.hpp"
#include "engine/effects/size_spread.hpp"
#include "engine/effects/sliding_friction.hpp"
#include "engine/effects/tabulated_sizes.hpp"

namespace repose::engine {

using AllEffects = std::tuple<effects::SizeSpread,
                              effects::LogNormalSizes,
                              effects::TabulatedSizes,
                              effects::GrainShape,
                              effects::Restitution,
                              effects::AreaCohesion,
                              effects::SlidingFriction,
                              effects::RollingResistance,
                              effects::ElasticRollingResistance,
                              effects::OwnSpinRollingResistance>;

inline constexpr std::size_t effect_count = std::tuple_size_v<AllEffects>;

}  // namespace repose::engine
