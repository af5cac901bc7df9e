/// A picture of a frame: spheres and swept walls, shaded, with gravity pointing down the page.
/// Walls between the viewer and the bed are glass; what is empty is transparent, so that the
/// picture lies on a light page as well as on a dark one.
#pragma once

#include "engine/frame.hpp"
#include "server/report/image.hpp"

namespace repose::server {

struct PictureOptions {
  int width = 960;          ///< pixels
  int height = 720;         ///< pixels
  double azimuth = 0.42;    ///< rad, of the viewer from -y towards +x
  double elevation = 0.38;  ///< rad, of the viewer above the horizon
};

/// Pure: equal frames give equal pixels. A frame without grains gives an empty page.
Image picture(const engine::Frame& frame, const PictureOptions& options = {});

}  // namespace repose::server
