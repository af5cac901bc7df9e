/// The reference grain: soybean as it stands in comparisons between codes. Used where no study
/// names a material.
#pragma once

#include "engine/parameter_set.hpp"

namespace repose::server {

/// Spheres of one size after Boac et al. 2010, Trans. ASABE 53(4), 1201-1216, with the friction of
/// their best set; the wall has the grain's own elasticity.
engine::ParameterSet reference_grain();

}  // namespace repose::server
