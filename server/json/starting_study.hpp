/// A study to start from: what is published of a material, as a study document that can be run.
#pragma once

#include <string>
#include <vector>

#include "server/json/material_library.hpp"

namespace repose::server {

struct StartingStudy {
  std::string text;                ///< schemas/calibration.schema.json, indented
  std::vector<std::string> notes;  ///< what was chosen or assumed where the source leaves it open
};

/// Free is what is published as a range: restitution, friction. Fixed is what is published as one
/// value. Where nothing is published a stand-in of the library takes its place. The published bulk
/// density and static angle are the measurements, until the user's own replace them.
StartingStudy starting_study(const PublishedMaterial& material);

}  // namespace repose::server
