/// Motion: grains under their loads for a step, velocities half a step behind positions (leapfrog:
/// kick, then drift).
#pragma once

#include "engine/contact_list.hpp"
#include "engine/grains.hpp"

namespace repose::engine {

struct Motion {
  Vec3 gravity;  ///< m/s2
  double dt;     ///< s
  Grains& grains;
  const ContactList::Anchor* anchors;  ///< one for each row
  std::uint32_t first_row, last_row;   ///< to move: from the first to before the last
  bool outlived = false;               ///< whether a grain has used up its skin
};

/// Moves the grains of these rows and clears their loads.
void advance(Motion& motion);

}  // namespace repose::engine
