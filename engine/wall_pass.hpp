/// WallPass: a step's forces between grains and walls. As for pairs, but the other end of a contact
/// is the nearest point of a surface.
#pragma once

#include <span>

#include "engine/boundary.hpp"
#include "engine/contact_list.hpp"
#include "engine/contact_model.hpp"
#include "engine/grains.hpp"
#include "engine/wall_motion.hpp"

namespace repose::engine {

struct WallPass {
  const ContactModel& model;
  std::span<const Surface> surfaces;
  double dt;     ///< s
  double reach;  ///< gap up to which a contact that has closed stays closed, m
  const GrainRow* rows;
  GrainLoad* loads;
  std::span<WallLoad> wall_loads;  ///< one for each surface; added to
  Candidates& candidates;
  int history_columns;
  ContactBlock& block;     ///< room to work in
  std::size_t closed = 0;  ///< contacts found
};

void push_walls(WallPass& pass);

}  // namespace repose::engine
