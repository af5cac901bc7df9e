/// Soybean shapes of one to four spheres of equal volume, as published.
///
/// Source: Boac et al. 2010, Trans. ASABE 53(4), 1201-1216, Table 7 (the last after LoCurto et al.
/// 1997 and Vu-Quoc et al. 2000). The centres are printed without a unit; they are mm, since only
/// so do they give the printed length and volume (143.5 mm3).
#pragma once

#include <array>
#include <span>

#include "engine/clump_shape.hpp"

namespace repose::engine {

inline constexpr std::size_t most_soybean_spheres = 4;

namespace soybean {

inline constexpr std::array one{ClumpMember{{0.0, 0.0, 0.0}, 3.248e-3}};
inline constexpr std::array two{ClumpMember{{0.0, 0.0, 0.0}, 2.85e-3},
                                ClumpMember{{0.0, 0.0, 1.89e-3}, 2.85e-3}};
inline constexpr std::array three{ClumpMember{{0.0, 0.0, 0.0}, 2.75e-3},
                                  ClumpMember{{0.0, 0.0, 1.975e-3}, 2.75e-3},
                                  ClumpMember{{0.0, 0.8e-3, 0.9875e-3}, 2.75e-3}};
inline constexpr std::array four{ClumpMember{{0.0, -0.35e-3, 0.0}, 2.75e-3},
                                 ClumpMember{{0.0, 0.35e-3, 0.0}, 2.75e-3},
                                 ClumpMember{{0.0, 0.0, 1.062e-3}, 2.75e-3},
                                 ClumpMember{{0.0, 0.0, -1.062e-3}, 2.75e-3}};

}  // namespace soybean

/// By the number of spheres less one.
inline constexpr std::array<std::span<const ClumpMember>, most_soybean_spheres> soybean_shapes{
    soybean::one, soybean::two, soybean::three, soybean::four};

}  // namespace repose::engine
