/// Frame: what a run looks like at one moment, for pictures, replays and files.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "engine/triangle.hpp"
#include "engine/vec3.hpp"

namespace repose::engine {

struct FrameGrain {
  Vec3 centre;             ///< m
  Vec3 velocity;           ///< m/s
  double radius = 0.0;     ///< m
  std::uint64_t id = 0;    ///< stays with the grain through the run
  std::uint64_t body = 0;  ///< equal for the members of a clump: the first one's id; a sphere's own
};

/// What has no end runs to minus and plus this: beyond any apparatus, and near enough to keep its
/// digits, m.
inline constexpr double endless = 64.0;

/// A wall as a curve in a half plane that is swept round an upright axis or along y, or as
/// triangles.
struct FrameWall {
  bool revolved = false;              ///< swept round z; else along y
  double from_s = 0.0, from_z = 0.0;  ///< m; s is the radius (revolved) or x
  double to_s = 0.0, to_z = 0.0;
  double centre_x = 0.0, centre_y = 0.0;
  std::vector<Triangle> triangles = {};  ///< instead of the curve, where there are any
  bool closed = false;  ///< a side of a closed section along y, such as the mantle of a lying drum
};

struct Frame {
  std::string_view stage;  ///< "filled", "tilted", ... ; "running" between stages
  double time = 0.0;       ///< s since the start of the run
  Vec3 gravity;            ///< m/s2, in the frame of the apparatus
  Vec3 period;             ///< m; 0 where not periodic
  std::span<const FrameGrain> grains;
  std::span<const FrameWall> walls;
};

using FrameSink = std::function<void(const Frame&)>;

}  // namespace repose::engine
