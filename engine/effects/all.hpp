/// Every effect there is, in the order a step applies them. To add one: its file, its line here.
#pragma once

#include <tuple>

#include "engine/effects/air_drag.hpp"
#include "engine/effects/area_cohesion.hpp"
#include "engine/effects/capillary_bridge.hpp"
#include "engine/effects/elastic_rolling_resistance.hpp"
#include "engine/effects/grain_shape.hpp"
#include "engine/effects/hysteresis.hpp"
#include "engine/effects/jkr_adhesion.hpp"
#include "engine/effects/log_normal_sizes.hpp"
#include "engine/effects/moisture_density.hpp"
#include "engine/effects/moisture_friction.hpp"
#include "engine/effects/moisture_softening.hpp"
#include "engine/effects/own_spin_rolling_resistance.hpp"
#include "engine/effects/plastic_restitution.hpp"
#include "engine/effects/restitution.hpp"
#include "engine/effects/rolling_resistance.hpp"
#include "engine/effects/size_spread.hpp"
#include "engine/effects/sliding_friction.hpp"
#include "engine/effects/sphere_clump.hpp"
#include "engine/effects/tabulated_sizes.hpp"
#include "engine/effects/tapping.hpp"
#include "engine/effects/twisting_resistance.hpp"
#include "engine/effects/velocity_restitution.hpp"
#include "engine/effects/velocity_weakening.hpp"

namespace repose::engine {

using AllEffects = std::tuple<effects::MoistureSoftening,
                              effects::MoistureFriction,
                              effects::MoistureDensity,
                              effects::SizeSpread,
                              effects::LogNormalSizes,
                              effects::TabulatedSizes,
                              effects::GrainShape,
                              effects::SphereClump,
                              effects::Tapping,
                              effects::PlasticRestitution,
                              effects::Hysteresis,
                              effects::Restitution,
                              effects::VelocityRestitution,
                              effects::AreaCohesion,
                              effects::JkrAdhesion,
                              effects::CapillaryBridge,
                              effects::VelocityWeakening,
                              effects::SlidingFriction,
                              effects::RollingResistance,
                              effects::ElasticRollingResistance,
                              effects::OwnSpinRollingResistance,
                              effects::TwistingResistance,
                              effects::AirDrag>;

inline constexpr std::size_t effect_count = std::tuple_size_v<AllEffects>;

}  // namespace repose::engine
