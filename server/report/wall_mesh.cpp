#include "server/report/wall_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

namespace repose::server {

using engine::FrameWall;
using engine::Vec3;

namespace {

constexpr int slices = 120;  // of a full turn

/// A point of a wall's curve.
struct Place {
  double s, z;
};

/// A piece of a wall's curve inside the bounds.
struct Piece {
  Place from, to;
  bool from_is_end, to_is_end;  ///< not where it was cut
};

/// Cuts a segment to a box (Liang & Barsky 1984, ACM Trans. Graphics 3, 1-22).
std::optional<Piece> cut(const FrameWall& wall, Place lower, Place upper) {
  const double ds = wall.to_s - wall.from_s, dz = wall.to_z - wall.from_z;
  double first = 0.0, last = 1.0;
  const auto keep = [&](double slope, double room) {  // slope * t <= room
    if (slope == 0.0) return room >= 0.0;
    const double t = room / slope;
    if (slope > 0.0) last = std::min(last, t);
    if (slope < 0.0) first = std::max(first, t);
    return first <= last;
  };
  if (!keep(-ds, wall.from_s - lower.s) || !keep(ds, upper.s - wall.from_s) ||
      !keep(-dz, wall.from_z - lower.z) || !keep(dz, upper.z - wall.from_z)) {
    return std::nullopt;
  }
  const auto at = [&](double t) { return Place{wall.from_s + t * ds, wall.from_z + t * dz}; };
  return Piece{at(first), at(last), first == 0.0, last == 1.0};
}

/// Whether another wall goes on where this one ends.
bool continues(std::span<const FrameWall> walls, const FrameWall& self, Place end) {
  constexpr double close = 1e-7;  // m
  return std::ranges::any_of(walls, [&](const FrameWall& other) {
    if (&other == &self || other.revolved != self.revolved) return false;
    const auto meets = [&](double s, double z) {
      return std::abs(s - end.s) < close && std::abs(z - end.z) < close;
    };
    return meets(other.from_s, other.from_z) || meets(other.to_s, other.to_z);
  });
}

/// Corners as a key; equal corners have equal bits, as a mesh's are welded.
using Key = std::array<double, 3>;
Key key(const Vec3& v) { return {v.x, v.y, v.z}; }

/// Collects patches and edges; knows the frame and where walls are cut.
class MeshBuilder {
 public:
  MeshBuilder(const engine::Frame& frame, const Bounds& bounds)
      : frame_(frame), bounds_(bounds), bed_(bounds_of(frame.grains)) {
    if (frame.period.y > 0.0) {
      // Sides of a periodic apparatus: whole periods from 0 or half periods about it.
      const bool about_zero = bed_.lower.y < -0.25 * frame.period.y;
      near_y_ = about_zero ? -0.5 * frame.period.y : 0.0;
      far_y_ = near_y_ + frame.period.y;
    } else {
      near_y_ = bed_.lower.y;
      far_y_ = bed_.upper.y;
    }
  }

  WallSurfaces build() {
    for (const FrameWall& wall : frame_.walls) {
      if (!wall.triangles.empty()) {
        facet(wall);
      } else if (wall.revolved) {
        revolve(wall);
      } else {
        extrude(wall);
      }
    }
    return std::move(surfaces_);
  }

 private:
  /// Unit normal (s, z) of a piece that points away from the place (s, z).
  static Place away(const Piece& piece, Place centre) {
    const double ds = piece.to.s - piece.from.s, dz = piece.to.z - piece.from.z;
    const double length = std::hypot(ds, dz);
    const Place middle{0.5 * (piece.from.s + piece.to.s), 0.5 * (piece.from.z + piece.to.z)};
    const double side = (middle.s - centre.s) * dz - (middle.z - centre.z) * ds;
    const double sign = side < 0.0 ? -1.0 : 1.0;
    return {sign * dz / length, -sign * ds / length};
  }

  /// Triangles stand as they are; their edges are those of one triangle only.
  void facet(const FrameWall& wall) {
    std::map<std::pair<Key, Key>, int> uses;
    for (const engine::Triangle& t : wall.triangles) {
      const Vec3 across = cross(t[1] - t[0], t[2] - t[0]);
      const double side = dot(across, t[0] - bed_.centre());
      const Vec3 n = ((side < 0.0 ? -1.0 : 1.0) / std::max(norm(across), 1e-30)) * across;
      surfaces_.patches.push_back({{t[0], t[1], t[2], t[2]}, {n, n, n, n}});
      for (std::size_t k = 0; k < 3; ++k) {
        ++uses[std::minmax({key(t.at(k)), key(t.at((k + 1) % 3))})];
      }
    }
    for (const auto& [ends, count] : uses) {
      const auto& [a, b] = ends;
      if (count == 1) surfaces_.edges.push_back({{a[0], a[1], a[2]}, {b[0], b[1], b[2]}});
    }
  }

  void revolve(const FrameWall& wall) {
    const double reach_x =
        std::max(bounds_.upper.x - wall.centre_x, wall.centre_x - bounds_.lower.x);
    const double reach_y =
        std::max(bounds_.upper.y - wall.centre_y, wall.centre_y - bounds_.lower.y);
    const auto piece =
        cut(wall, {0.0, bounds_.lower.z}, {std::max(reach_x, reach_y), bounds_.upper.z});
    if (!piece) return;
    const Place normal = away(*piece, {0.0, bed_.centre().z});
    const auto point = [&](Place p, int slice) {
      const double angle = 2.0 * std::numbers::pi * slice / slices;
      return Vec3{
          wall.centre_x + p.s * std::cos(angle), wall.centre_y + p.s * std::sin(angle), p.z};
    };
    const auto direction = [&](int slice) {
      const double angle = 2.0 * std::numbers::pi * slice / slices;
      return Vec3{normal.s * std::cos(angle), normal.s * std::sin(angle), normal.z};
    };
    for (int i = 0; i < slices; ++i) {
      const Vec3 n = direction(i), next = direction(i + 1);
      surfaces_.patches.push_back({{point(piece->from, i),
                                    point(piece->from, i + 1),
                                    point(piece->to, i + 1),
                                    point(piece->to, i)},
                                   {n, next, next, n}});
      if (is_rim(wall, piece->from, piece->from_is_end)) {
        surfaces_.edges.push_back({point(piece->from, i), point(piece->from, i + 1)});
      }
      if (is_rim(wall, piece->to, piece->to_is_end)) {
        surfaces_.edges.push_back({point(piece->to, i), point(piece->to, i + 1)});
      }
    }
  }

  void extrude(const FrameWall& wall) {
    const auto piece =
        cut(wall, {bounds_.lower.x, bounds_.lower.z}, {bounds_.upper.x, bounds_.upper.z});
    if (!piece) return;
    const Place n = away(*piece, {bed_.centre().x, bed_.centre().z});
    const Vec3 normal{n.s, 0.0, n.z};
    const auto point = [&](Place p, double y) { return Vec3{p.s, y, p.z}; };
    const Vec3 a = point(piece->from, near_y_), b = point(piece->to, near_y_);
    const Vec3 c = point(piece->to, far_y_), d = point(piece->from, far_y_);
    surfaces_.patches.push_back({{a, b, c, d}, {normal, normal, normal, normal}});
    surfaces_.edges.push_back({a, b});
    surfaces_.edges.push_back({d, c});
    if (is_rim(wall, piece->from, piece->from_is_end)) surfaces_.edges.push_back({a, d});
    if (is_rim(wall, piece->to, piece->to_is_end)) surfaces_.edges.push_back({b, c});
  }

  [[nodiscard]] bool is_rim(const FrameWall& wall, Place end, bool is_end) const {
    return is_end && !continues(frame_.walls, wall, end) && !(wall.revolved && end.s == 0.0);
  }

  const engine::Frame& frame_;
  const Bounds& bounds_;
  Bounds bed_;
  double near_y_ = 0.0, far_y_ = 0.0;  // m, sides of what is swept along y
  WallSurfaces surfaces_;
};

/// Puts the ends of a wall that has some into a box.
void include_ends(Bounds& bounds, const FrameWall& wall) {
  for (const engine::Triangle& triangle : wall.triangles) {
    for (const Vec3& corner : triangle) bounds.include(corner);
  }
  if (!wall.triangles.empty()) return;
  const Vec3 middle = bounds.centre();
  const auto include = [&](double s, double z) {
    if (std::abs(s) >= engine::endless || std::abs(z) >= engine::endless) return;
    if (!wall.revolved) return bounds.include({s, middle.y, z});
    bounds.include({wall.centre_x - s, wall.centre_y - s, z});
    bounds.include({wall.centre_x + s, wall.centre_y + s, z});
  };
  include(wall.from_s, wall.from_z);
  include(wall.to_s, wall.to_z);
}

/// The box round the bed with a fifth of its largest side about it.
Bounds widened_bed(const engine::Frame& frame) {
  Bounds bounds = bounds_of(frame.grains);
  const Vec3 size = bounds.size();
  const double margin = 0.2 * std::max({size.x, size.y, size.z});
  const Vec3 lower = bounds.lower, upper = bounds.upper;
  bounds.include(lower, margin);
  bounds.include(upper, margin);
  return bounds;
}

}  // namespace

Bounds surroundings(const engine::Frame& frame) {
  Bounds bounds = widened_bed(frame);
  for (const FrameWall& wall : frame.walls) {
    if (wall.closed) include_ends(bounds, wall);
  }
  return bounds;
}

Bounds whole_apparatus(const engine::Frame& frame) {
  Bounds bounds = widened_bed(frame);
  for (const FrameWall& wall : frame.walls) include_ends(bounds, wall);
  return bounds;
}

WallSurfaces wall_surfaces(const engine::Frame& frame, const Bounds& bounds) {
  if (frame.grains.empty()) return {};
  return MeshBuilder(frame, bounds).build();
}

WallMesh wall_mesh(const engine::Frame& frame, const ViewAxes& axes) {
  if (frame.grains.empty()) return {};
  WallSurfaces surfaces = wall_surfaces(frame, surroundings(frame));
  WallMesh mesh;
  for (const WallPatch& patch : surfaces.patches) {
    const bool outside_is_seen = dot(patch.normals[0] + patch.normals[2], axes.toward) > 0.0;
    (outside_is_seen ? mesh.before : mesh.behind).push_back(patch);
  }
  mesh.edges = std::move(surfaces.edges);
  return mesh;
}

}  // namespace repose::server
