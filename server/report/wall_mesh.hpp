/// WallMesh: the walls of a frame as surfaces with edges; what is swept is cut into flat patches.
#pragma once

#include <array>
#include <vector>

#include "server/report/view.hpp"

namespace repose::server {

/// Four corners in the apparatus' frame, with a normal (away from the bed) at each. Of a triangle
/// the last two are the same.
struct WallPatch {
  std::array<engine::Vec3, 4> corners;
  std::array<engine::Vec3, 4> normals;
};

struct WallEdge {
  engine::Vec3 from, to;
};

struct WallSurfaces {
  std::vector<WallPatch> patches;
  std::vector<WallEdge> edges;  ///< rims and the ends of swept sections
};

/// The surroundings of the bed, with the whole of what is closed about it: cut to these, a hopper
/// far above or an endless floor does not shrink a picture.
Bounds surroundings(const engine::Frame& frame);

/// The bed with every wall that has an end: only what is endless is cut.
Bounds whole_apparatus(const engine::Frame& frame);

/// The walls inside the bounds; along y as far as the bed or the period. None without grains.
WallSurfaces wall_surfaces(const engine::Frame& frame, const Bounds& bounds);

/// The walls in the bed's surroundings as a viewer sees them.
struct WallMesh {
  std::vector<WallPatch> behind;  ///< seen from inside, drawn solid
  std::vector<WallPatch> before;  ///< between the viewer and the bed, drawn as glass
  std::vector<WallEdge> edges;
};

WallMesh wall_mesh(const engine::Frame& frame, const ViewAxes& axes);

}  // namespace repose::server
