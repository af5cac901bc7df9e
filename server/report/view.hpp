/// View: from where a frame is looked at. Orthographic, three-quarter, gravity down the page.
#pragma once

#include <span>

#include "engine/frame.hpp"

namespace repose::server {

/// A box along the axes; empty until something is put in.
struct Bounds {
  engine::Vec3 lower{1e300, 1e300, 1e300};
  engine::Vec3 upper{-1e300, -1e300, -1e300};

  [[nodiscard]] bool empty() const { return lower.x > upper.x; }
  void include(const engine::Vec3& point, double margin = 0.0);
  [[nodiscard]] engine::Vec3 centre() const { return 0.5 * (lower + upper); }
  [[nodiscard]] engine::Vec3 size() const { return upper - lower; }
};

/// The box round all grains, m.
Bounds bounds_of(std::span<const engine::FrameGrain> grains);

/// Three unit vectors in the apparatus' frame: to the right of the page, up the page, to the
/// viewer.
struct ViewAxes {
  engine::Vec3 right, up, toward;

  /// From the apparatus' frame to (right, up, toward), m.
  [[nodiscard]] engine::Vec3 turn(const engine::Vec3& p) const {
    return {dot(right, p), dot(up, p), dot(toward, p)};
  }
};

/// Looking from `azimuth` (rad, counted from -y towards +x) and `elevation` (rad) in the
/// laboratory, where gravity points down: a tilted apparatus looks tilted.
ViewAxes view_axes(const engine::Vec3& gravity, double azimuth, double elevation);

/// Metres on the page to pixels; y grows downwards, depth (m) towards the viewer.
struct Projection {
  ViewAxes axes;
  double scale = 1.0;                     ///< pixels per metre
  double origin_x = 0.0, origin_y = 0.0;  ///< pixels

  [[nodiscard]] engine::Vec3 operator()(const engine::Vec3& p) const {
    const engine::Vec3 q = axes.turn(p);
    return {origin_x + scale * q.x, origin_y - scale * q.y, q.z};
  }
};

/// The largest projection that shows the box (already turned, m) in a page of that many pixels.
Projection fit(const ViewAxes& axes, const Bounds& turned, int width, int height);

}  // namespace repose::server
