#include "server/report/raster.hpp"

#include <algorithm>
#include <cmath>

namespace repose::server {

using engine::Vec3;

namespace {

struct Span {
  int from, to;  ///< pixels, both included
};

/// The pixels whose centres may lie between two places, cut to the page.
Span pixels(double lower, double upper, int page) {
  const double last = page - 1;
  return {static_cast<int>(std::clamp(std::floor(lower), 0.0, last)),
          static_cast<int>(std::clamp(std::ceil(upper), -1.0, last))};
}

}  // namespace

void Raster::sphere(const Vec3& centre, double radius, double scale, std::int32_t what) {
  const Span rows = pixels(centre.y - radius, centre.y + radius, height_);
  const Span columns = pixels(centre.x - radius, centre.x + radius, width_);
  for (int y = rows.from; y <= rows.to; ++y) {
    for (int x = columns.from; x <= columns.to; ++x) {
      const double dx = (x + 0.5 - centre.x) / radius, dy = (centre.y - y - 0.5) / radius;
      const double rest = 1.0 - dx * dx - dy * dy;
      if (rest < 0.0) continue;
      const double dz = std::sqrt(rest);
      put(x,
          y,
          {static_cast<float>(centre.z + dz * radius / scale),
           static_cast<float>(dx),
           static_cast<float>(dy),
           static_cast<float>(dz),
           what});
    }
  }
}

void Raster::triangle(const Corner& a, const Corner& b, const Corner& c, std::int32_t what) {
  const double area = (b.at.x - a.at.x) * (c.at.y - a.at.y) - (c.at.x - a.at.x) * (b.at.y - a.at.y);
  if (std::abs(area) < 1e-12) return;  // seen from the edge
  const Span rows =
      pixels(std::min({a.at.y, b.at.y, c.at.y}), std::max({a.at.y, b.at.y, c.at.y}), height_);
  const Span columns =
      pixels(std::min({a.at.x, b.at.x, c.at.x}), std::max({a.at.x, b.at.x, c.at.x}), width_);
  for (int y = rows.from; y <= rows.to; ++y) {
    for (int x = columns.from; x <= columns.to; ++x) {
      const double px = x + 0.5, py = y + 0.5;
      const double v =
          ((px - a.at.x) * (c.at.y - a.at.y) - (c.at.x - a.at.x) * (py - a.at.y)) / area;
      const double w =
          ((b.at.x - a.at.x) * (py - a.at.y) - (px - a.at.x) * (b.at.y - a.at.y)) / area;
      const double u = 1.0 - v - w;
      if (u < -1e-9 || v < -1e-9 || w < -1e-9) continue;
      const Vec3 n = u * a.normal + v * b.normal + w * c.normal;
      put(x,
          y,
          {static_cast<float>(u * a.at.z + v * b.at.z + w * c.at.z),
           static_cast<float>(n.x),
           static_cast<float>(n.y),
           static_cast<float>(n.z),
           what});
    }
  }
}

void Raster::line(const Vec3& from, const Vec3& to, double thickness, std::int32_t what) {
  const double half = 0.5 * thickness;
  const int steps = 1 + static_cast<int>(std::hypot(to.x - from.x, to.y - from.y));
  for (int i = 0; i <= steps; ++i) {
    const Vec3 p = from + (static_cast<double>(i) / steps) * (to - from);
    const Span rows = pixels(p.y - half, p.y + half, height_);
    const Span columns = pixels(p.x - half, p.x + half, width_);
    for (int y = rows.from; y <= rows.to; ++y) {
      for (int x = columns.from; x <= columns.to; ++x) {
        if (std::hypot(x + 0.5 - p.x, y + 0.5 - p.y) > half) continue;
        put(x, y, {static_cast<float>(p.z), 0.0F, 0.0F, 1.0F, what});
      }
    }
  }
}

}  // namespace repose::server
