/// Raster: the nearest surface behind every pixel of a page, drawn from spheres and triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/vec3.hpp"

namespace repose::server {

/// What is seen through one pixel.
struct Fragment {
  float depth = -1e30F;                   ///< m towards the viewer
  float nx = 0.0F, ny = 0.0F, nz = 0.0F;  ///< normal: right, up, towards the viewer
  std::int32_t what = -1;                 ///< what the caller drew; -1: nothing

  [[nodiscard]] bool empty() const { return what < 0; }
};

/// One corner as drawn: pixels, and metres towards the viewer.
struct Corner {
  engine::Vec3 at;
  engine::Vec3 normal;
};

class Raster {
 public:
  Raster(int width, int height)
      : width_(width),
        height_(height),
        fragments_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const Fragment& at(int x, int y) const { return fragments_[index(x, y)]; }

  /// A sphere: centre in pixels (z: m), radius in pixels, pixels per metre.
  void sphere(const engine::Vec3& centre, double radius, double scale, std::int32_t what);
  void triangle(const Corner& a, const Corner& b, const Corner& c, std::int32_t what);
  /// A line `thickness` pixels wide.
  void line(const engine::Vec3& from, const engine::Vec3& to, double thickness, std::int32_t what);

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  void put(int x, int y, const Fragment& fragment) {
    Fragment& old = fragments_[index(x, y)];
    if (fragment.depth > old.depth) old = fragment;
  }

  int width_, height_;
  std::vector<Fragment> fragments_;
};

}  // namespace repose::server
