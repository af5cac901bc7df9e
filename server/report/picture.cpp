#include "server/report/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "server/report/raster.hpp"
#include "server/report/view.hpp"
#include "server/report/wall_mesh.hpp"

namespace repose::server {

using engine::Vec3;

namespace {

constexpr int samples = 2;  // along each side of a pixel

// What a fragment shows: a wall, an edge, or a grain (first_grain + its index).
constexpr std::int32_t wall = 0, edge = 1, first_grain = 2;

/// Linear light, 0 to 1.
using Colour = Vec3;

/// From the colours of screens (IEC 61966-2-1) to linear light and back.
double to_linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }
double to_screen(double c) {
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}
Colour screen_colour(double red, double green, double blue) {
  return {to_linear(red / 255.0), to_linear(green / 255.0), to_linear(blue / 255.0)};
}

Vec3 unit(const Vec3& v) { return (1.0 / std::max(norm(v), 1e-30)) * v; }

Colour mix(const Colour& a, const Colour& b, double share) { return (1.0 - share) * a + share * b; }

/// A grain's own colour: from pale to deep straw by its number, so that neighbours can be told
/// apart and a clump is seen as one.
Colour grain_colour(std::uint64_t body) {
  std::uint64_t bits = (body + 1) * 0x9E3779B97F4A7C15ULL;  // golden ratio: spreads small numbers
  bits ^= bits >> 29U;
  bits *= 0xBF58476D1CE4E5B9ULL;
  const double share = static_cast<double>(bits >> 40U) / static_cast<double>(1U << 24U);
  return mix(screen_colour(188, 128, 62), screen_colour(240, 205, 146), share);
}

/// Light of a clear room: a lamp above the viewer's left shoulder, sky above, warm floor below.
struct Light {
  Vec3 lamp = unit({-0.50, 0.72, 0.62});  ///< right, up, towards the viewer

  [[nodiscard]] Colour shade(const Colour& own, const Vec3& n, double open, double lit) const {
    const double sky = 0.5 + 0.5 * n.y;
    const Colour ambient = mix({0.36, 0.31, 0.27}, {0.56, 0.60, 0.68}, sky);
    const double lamp_share = 1.05 * lit * std::max(0.0, dot(n, lamp));
    const Vec3 half = unit(lamp + Vec3{0.0, 0.0, 1.0});
    const double gloss = 0.10 * lit * std::pow(std::max(0.0, dot(n, half)), 28.0);
    const auto channel = [&](double colour, double room) {
      return colour * (room * open + lamp_share * (0.45 + 0.55 * open)) + gloss;
    };
    return {channel(own.x, ambient.x), channel(own.y, ambient.y), channel(own.z, ambient.z)};
  }
};

/// Premultiplied linear colour and how much it covers.
struct Tint {
  Colour colour;
  double cover = 0.0;

  void over(const Colour& front, double alpha) {
    colour = (1.0 - alpha) * colour + alpha * front;
    cover = (1.0 - alpha) * cover + alpha;
  }
};

/// How much of the sky a place sees, from the depths round it ("Alchemy" ambient obscurance,
/// McGuire et al. 2011): 1 open, 0 shut in.
double openness(const Raster& scene, int x, int y, double scale, double reach) {
  constexpr int rays = 14;
  const Fragment& here = scene.at(x, y);
  const double radius = reach * scale;                 // pixels
  const double start = 0.7 * ((x & 3) * 4 + (y & 3));  // the pattern turns from pixel to pixel
  double shut = 0.0;
  for (int i = 0; i < rays; ++i) {
    const double share = (i + 0.5) / rays;
    const double angle = start + 2.399963 * i;  // golden angle, rad
    const int px = x + static_cast<int>(std::lround(radius * share * std::cos(angle)));
    const int py = y + static_cast<int>(std::lround(radius * share * std::sin(angle)));
    if (px < 0 || py < 0 || px >= scene.width() || py >= scene.height()) continue;
    const Fragment& there = scene.at(px, py);
    if (there.empty()) continue;
    const Vec3 way{(px - x) / scale, (y - py) / scale, there.depth - here.depth};
    const double rise = way.x * here.nx + way.y * here.ny + way.z * here.nz - 0.03 * reach;
    shut += std::max(0.0, rise) / (dot(way, way) + 0.02 * reach * reach);
  }
  return std::clamp(1.0 - 1.1 * reach * shut / rays, 0.0, 1.0);
}

/// The scene as the lamp sees it; tells how much of the lamp a place sees.
class Shadow {
 public:
  Shadow(const engine::Frame& frame, const ViewAxes& axes, const Vec3& lamp) : raster_(size, size) {
    const Vec3 side = unit(cross(Vec3{0.0, 1.0, 0.0}, lamp));
    const Vec3 up = cross(lamp, side);
    const auto back = [&](const Vec3& v) {  // from the page to the apparatus
      return v.x * axes.right + v.y * axes.up + v.z * axes.toward;
    };
    const ViewAxes seen{back(side), back(up), back(lamp)};
    Bounds turned;
    for (const auto& grain : frame.grains) turned.include(seen.turn(grain.centre), grain.radius);
    projection_ = fit(seen, turned, size, size);
    for (const auto& grain : frame.grains) {
      raster_.sphere(
          projection_(grain.centre), grain.radius * projection_.scale, projection_.scale, 0);
    }
  }

  [[nodiscard]] double lit(const Vec3& place, double slack) const {
    const Vec3 p = projection_(place);
    int open = 0;
    for (int i = 0; i < 9; ++i) {
      const int x = static_cast<int>(p.x) + 2 * (i % 3 - 1);
      const int y = static_cast<int>(p.y) + 2 * (i / 3 - 1);
      const bool outside = x < 0 || y < 0 || x >= size || y >= size;
      open += outside || raster_.at(x, y).depth < p.z + slack ? 1 : 0;
    }
    return open / 9.0;
  }

 private:
  static constexpr int size = 1400;  // pixels
  Raster raster_;
  Projection projection_;
};

/// Draws one frame.
class Painter {
 public:
  Painter(const engine::Frame& frame, const PictureOptions& options)
      : frame_(frame),
        width_(options.width * samples),
        height_(options.height * samples),
        axes_(view_axes(frame.gravity, options.azimuth, options.elevation)),
        mesh_(wall_mesh(frame, axes_)),
        shadow_(frame, axes_, light_.lamp),
        scene_(width_, height_),
        glass_(width_, height_),
        lines_(width_, height_) {
    Bounds turned;
    for (const auto& grain : frame.grains) turned.include(axes_.turn(grain.centre), grain.radius);
    for (const auto* patches : {&mesh_.behind, &mesh_.before}) {
      for (const WallPatch& patch : *patches) {
        for (const Vec3& corner : patch.corners) turned.include(axes_.turn(corner));
      }
    }
    projection_ = fit(axes_, turned, width_, height_);
    diameter_ = 2.0 * mean_radius();
    draw();
  }

  [[nodiscard]] Tint tint(int x, int y) const {
    Tint result;
    const Fragment& solid = scene_.at(x, y);
    if (!solid.empty()) {
      result.over(solid.what == wall ? wall_light(x, y, solid) : grain_light(x, y, solid), 1.0);
    }
    const Fragment& glass = glass_.at(x, y);
    if (!glass.empty() && glass.depth > solid.depth) {
      const double edge_on = 1.0 - std::abs(static_cast<double>(glass.nz));
      const double alpha = 0.05 + 0.40 * std::pow(edge_on, 3.0);
      result.over(screen_colour(176, 198, 218), alpha);
    }
    const Fragment& line = lines_.at(x, y);
    if (!line.empty() && line.depth > solid.depth - 0.1 * diameter_) {
      result.over(screen_colour(96, 110, 126), 0.85);
    }
    return result;
  }

 private:
  [[nodiscard]] double mean_radius() const {
    double sum = 0.0;
    for (const auto& grain : frame_.grains) sum += grain.radius;
    return sum / static_cast<double>(frame_.grains.size());
  }

  void draw() {
    std::int32_t what = first_grain;
    for (const auto& grain : frame_.grains) {
      const double radius = grain.radius * projection_.scale;
      scene_.sphere(projection_(grain.centre), radius, projection_.scale, what++);
    }
    for (const WallPatch& patch : mesh_.behind) draw(scene_, patch, -1.0);
    for (const WallPatch& patch : mesh_.before) draw(glass_, patch, 1.0);
    for (const WallEdge& line : mesh_.edges) {
      lines_.line(projection_(line.from), projection_(line.to), 1.5 * samples, edge);
    }
  }

  void draw(Raster& raster, const WallPatch& patch, double side) const {
    std::array<Corner, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) {
      corners[i] = {projection_(patch.corners[i]), axes_.turn(side * patch.normals[i])};
    }
    raster.triangle(corners[0], corners[1], corners[2], wall);
    raster.triangle(corners[0], corners[2], corners[3], wall);
  }

  /// Where a fragment is in the apparatus.
  [[nodiscard]] Vec3 place(int x, int y, const Fragment& f) const {
    const double right = (x + 0.5 - projection_.origin_x) / projection_.scale;
    const double up = (projection_.origin_y - y - 0.5) / projection_.scale;
    return right * axes_.right + up * axes_.up + static_cast<double>(f.depth) * axes_.toward;
  }

  [[nodiscard]] double open(int x, int y) const {
    const double near = openness(scene_, x, y, projection_.scale, 0.9 * diameter_);
    const double far = openness(scene_, x, y, projection_.scale, 4.0 * diameter_);
    return near * (0.35 + 0.65 * far);
  }

  [[nodiscard]] Colour grain_light(int x, int y, const Fragment& f) const {
    const auto& grain = frame_.grains[static_cast<std::size_t>(f.what - first_grain)];
    const double lit = shadow_.lit(place(x, y, f), 0.25 * diameter_);
    return light_.shade(grain_colour(grain.body), {f.nx, f.ny, f.nz}, open(x, y), lit);
  }

  [[nodiscard]] Colour wall_light(int x, int y, const Fragment& f) const {
    const double lit = shadow_.lit(place(x, y, f), 0.25 * diameter_);
    const Colour steel = screen_colour(158, 172, 188);
    const Colour shaded = light_.shade(steel, {f.nx, f.ny, f.nz}, open(x, y), 0.3 + 0.7 * lit);
    return 0.9 * shaded;
  }

  const engine::Frame& frame_;
  Light light_;
  int width_, height_;
  ViewAxes axes_;
  WallMesh mesh_;
  Shadow shadow_;
  Projection projection_;
  double diameter_ = 0.0;  // m, mean of the grains
  Raster scene_, glass_, lines_;
};

void write_pixel(const Painter& painter, int x, int y, std::uint8_t* pixel) {
  Colour sum;
  double cover = 0.0;
  for (int i = 0; i < samples * samples; ++i) {
    const Tint tint = painter.tint(x * samples + i % samples, y * samples + i / samples);
    sum += tint.colour;
    cover += tint.cover;
  }
  if (cover <= 0.0) return;
  const auto byte = [](double share) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
  };
  pixel[0] = byte(to_screen(std::clamp(sum.x / cover, 0.0, 1.0)));
  pixel[1] = byte(to_screen(std::clamp(sum.y / cover, 0.0, 1.0)));
  pixel[2] = byte(to_screen(std::clamp(sum.z / cover, 0.0, 1.0)));
  pixel[3] = byte(cover / (samples * samples));
}

}  // namespace

Image picture(const engine::Frame& frame, const PictureOptions& options) {
  Image image{options.width, options.height, {}};
  const auto width = static_cast<std::size_t>(options.width);
  image.rgba.assign(width * static_cast<std::size_t>(options.height) * 4, 0);
  if (frame.grains.empty()) return image;
  const Painter painter(frame, options);
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x) {
      const std::size_t index = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
      write_pixel(painter, x, y, image.rgba.data() + 4 * index);
    }
  }
  return image;
}

}  // namespace repose::server
