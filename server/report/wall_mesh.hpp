/// WallMesh: the swept walls of a frame as surfaces behind the bed, surfaces before it, and edges.
#pragma once

#include <array>
#include <vector>

#include "server/report/view.hpp"

namespace repose::server {

/// Four corners in the apparatus' frame, with a normal (away from the bed) at each.
struct WallPatch {
  std::array<engine::Vec3, 4> corners;
  std::array<engine::Vec3, 4> normals;
};

struct WallEdge {
  engine::Vec3 from, to;
};

struct WallMesh {
  std::vector<WallPatch> behind;  ///< seen from inside, drawn solid
  std::vector<WallPatch> before;  ///< between the viewer and the bed, drawn as glass
  std::vector<WallEdge> edges;    ///< rims and the ends of swept sections
};

/// Cut to the surroundings of the bed, so that a hopper far above or an endless floor does not
/// shrink the picture.
WallMesh wall_mesh(const engine::Frame& frame, const ViewAxes& axes);

}  // namespace repose::server
