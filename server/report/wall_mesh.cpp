#include "server/report/wall_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

namespace repose::server {

using engine::FrameWall;
using engine::Vec3;

namespace {

constexpr int slices = 120;  // of a full turn

/// A point of a wall's curve.
struct Place {
  double s, z;
};

/// A piece of a wall's curve inside the surroundings of the bed.
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

/// Collects patches and edges; knows the frame and the viewer.
class MeshBuilder {
 public:
  MeshBuilder(const engine::Frame& frame, const ViewAxes& axes)
      : frame_(frame), axes_(axes), bed_(bounds_of(frame.grains)) {
    const Vec3 size = bed_.size();
    margin_ = 0.2 * std::max({size.x, size.y, size.z});
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

  WallMesh build() {
    for (const FrameWall& wall : frame_.walls) {
      if (wall.revolved) revolve(wall);
      if (!wall.revolved) extrude(wall);
    }
    return std::move(mesh_);
  }

 private:
  void add(const WallPatch& patch) {
    const Vec3 normal = patch.normals[0] + patch.normals[2];
    const bool outside_is_seen = dot(normal, axes_.toward) > 0.0;
    (outside_is_seen ? mesh_.before : mesh_.behind).push_back(patch);
  }

  /// Unit normal (s, z) of a piece that points away from the place (s, z).
  static Place away(const Piece& piece, Place centre) {
    const double ds = piece.to.s - piece.from.s, dz = piece.to.z - piece.from.z;
    const double length = std::hypot(ds, dz);
    const Place middle{0.5 * (piece.from.s + piece.to.s), 0.5 * (piece.from.z + piece.to.z)};
    const double side = (middle.s - centre.s) * dz - (middle.z - centre.z) * ds;
    const double sign = side < 0.0 ? -1.0 : 1.0;
    return {sign * dz / length, -sign * ds / length};
  }

  void revolve(const FrameWall& wall) {
    const double reach_x = std::max(bed_.upper.x - wall.centre_x, wall.centre_x - bed_.lower.x);
    const double reach_y = std::max(bed_.upper.y - wall.centre_y, wall.centre_y - bed_.lower.y);
    const auto piece = cut(wall,
                           {0.0, bed_.lower.z - margin_},
                           {std::max(reach_x, reach_y) + margin_, bed_.upper.z + margin_});
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
      add({{point(piece->from, i),
            point(piece->from, i + 1),
            point(piece->to, i + 1),
            point(piece->to, i)},
           {n, next, next, n}});
      if (is_rim(wall, piece->from, piece->from_is_end)) {
        mesh_.edges.push_back({point(piece->from, i), point(piece->from, i + 1)});
      }
      if (is_rim(wall, piece->to, piece->to_is_end)) {
        mesh_.edges.push_back({point(piece->to, i), point(piece->to, i + 1)});
      }
    }
  }

  void extrude(const FrameWall& wall) {
    const auto piece = cut(wall,
                           {bed_.lower.x - margin_, bed_.lower.z - margin_},
                           {bed_.upper.x + margin_, bed_.upper.z + margin_});
    if (!piece) return;
    const Place n = away(*piece, {bed_.centre().x, bed_.centre().z});
    const Vec3 normal{n.s, 0.0, n.z};
    const auto point = [&](Place p, double y) { return Vec3{p.s, y, p.z}; };
    const Vec3 a = point(piece->from, near_y_), b = point(piece->to, near_y_);
    const Vec3 c = point(piece->to, far_y_), d = point(piece->from, far_y_);
    add({{a, b, c, d}, {normal, normal, normal, normal}});
    mesh_.edges.push_back({a, b});
    mesh_.edges.push_back({d, c});
    if (is_rim(wall, piece->from, piece->from_is_end)) mesh_.edges.push_back({a, d});
    if (is_rim(wall, piece->to, piece->to_is_end)) mesh_.edges.push_back({b, c});
  }

  [[nodiscard]] bool is_rim(const FrameWall& wall, Place end, bool is_end) const {
    return is_end && !continues(frame_.walls, wall, end) && !(wall.revolved && end.s == 0.0);
  }

  const engine::Frame& frame_;
  const ViewAxes& axes_;
  Bounds bed_;
  double margin_ = 0.0;                // m, round the bed
  double near_y_ = 0.0, far_y_ = 0.0;  // m, sides of what is swept along y
  WallMesh mesh_;
};

}  // namespace

WallMesh wall_mesh(const engine::Frame& frame, const ViewAxes& axes) {
  if (frame.grains.empty()) return {};
  return MeshBuilder(frame, axes).build();
}

}  // namespace repose::server
