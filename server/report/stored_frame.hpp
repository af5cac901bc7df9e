/// StoredFrame: a frame that outlives the call that showed it.
#pragma once

#include <string>
#include <vector>

#include "engine/frame.hpp"

namespace repose::server {

struct StoredFrame {
  std::string stage;
  double time = 0.0;     ///< s
  engine::Vec3 gravity;  ///< m/s2
  engine::Vec3 period;   ///< m
  std::vector<engine::FrameGrain> grains;
  std::vector<engine::FrameWall> walls;

  /// Valid as long as this is.
  [[nodiscard]] engine::Frame view() const { return {stage, time, gravity, period, grains, walls}; }
};

inline StoredFrame store(const engine::Frame& frame) {
  return {std::string(frame.stage),
          frame.time,
          frame.gravity,
          frame.period,
          {frame.grains.begin(), frame.grains.end()},
          {frame.walls.begin(), frame.walls.end()}};
}

}  // namespace repose::server
