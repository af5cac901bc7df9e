#include "engine/boundary.hpp"

#include <algorithm>
#include <cmath>

#include "engine/unit.hpp"

namespace repose::engine {

namespace {

Surface swept(Surface::Sweep sweep, Vec3 from, Vec3 to, MaterialId material) {
  Surface result;
  result.sweep = sweep;
  result.from_s = from.x;
  result.from_z = from.z;
  result.to_s = to.x;
  result.to_z = to.z;
  result.material = material;
  return result;
}

Vec3 unit_vector(const Vec3& v) { return (1.0 / norm(v)) * v; }

}  // namespace

Surface plane(double z, MaterialId material) { return strip(-endless, endless, z, material); }

Surface strip(double low_x, double high_x, double z, MaterialId material) {
  return swept(Surface::Sweep::extruded, {low_x, 0.0, z}, {high_x, 0.0, z}, material);
}

Surface upright(double x, double low, double high, MaterialId material) {
  return swept(Surface::Sweep::extruded, {x, 0.0, low}, {x, 0.0, high}, material);
}

Surface cylinder(double radius, double low, double high, MaterialId material) {
  return swept(Surface::Sweep::revolved, {radius, 0.0, low}, {radius, 0.0, high}, material);
}

Surface cone(double low_radius, double low, double high_radius, double high, MaterialId material) {
  return swept(
      Surface::Sweep::revolved, {low_radius, 0.0, low}, {high_radius, 0.0, high}, material);
}

Surface disc(double radius, double z, MaterialId material, double inner) {
  return swept(Surface::Sweep::revolved, {inner, 0.0, z}, {radius, 0.0, z}, material);
}

Surface lying_cylinder(double radius, double x, double z, MaterialId material) {
  Surface result;
  result.sweep = Surface::Sweep::lying;
  result.from_s = radius;
  result.axis_x = x;
  result.axis_z = z;
  result.pivot = {x, 0.0, z};
  result.material = material;
  return result;
}

std::vector<Surface> lying_ribs(
    int count, double radius, double height, double x, double z, MaterialId material) {
  std::vector<Surface> result;
  result.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * unit::pi * k / count;
    const Vec3 out{std::sin(angle), 0.0, -std::cos(angle)};
    const Vec3 axis{x, 0.0, z};
    result.push_back(swept(
        Surface::Sweep::extruded, axis + (radius - height) * out, axis + radius * out, material));
    result.back().pivot = axis;
  }
  return result;
}

Surface rectangle(const Vec3& centre, const Vec3& half_a, const Vec3& half_b, MaterialId material) {
  Surface result;
  result.sweep = Surface::Sweep::rectangle;
  result.material = material;
  result.pose.origin = centre;
  result.plate = {unit_vector(half_a), unit_vector(half_b), norm(half_a), norm(half_b)};
  return result;
}

std::vector<Surface> ribs(
    int count, double radius, double height, double low, double high, MaterialId material) {
  std::vector<Surface> result;
  result.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * unit::pi * k / count;
    const Vec3 out{std::cos(angle), std::sin(angle), 0.0};
    const Vec3 centre = (radius - 0.5 * height) * out + Vec3{0.0, 0.0, 0.5 * (low + high)};
    result.push_back(
        rectangle(centre, 0.5 * height * out, {0.0, 0.0, 0.5 * (high - low)}, material));
  }
  return result;
}

std::vector<Surface> mesh_surfaces(const std::shared_ptr<const Mesh>& mesh,
                                   MaterialId material,
                                   const Pose& pose) {
  std::vector<Surface> result(mesh->patches());
  for (std::uint32_t patch = 0; patch < result.size(); ++patch) {
    Surface& surface = result[patch];
    surface.sweep = Surface::Sweep::mesh;
    surface.material = material;
    surface.pose = pose;
    surface.mesh = mesh;
    surface.patch = patch;
  }
  return result;
}

namespace {

Vec3 offset_from_plate(const Plate& plate, const Vec3& centre) {
  const double a = dot(centre, plate.along_a), b = dot(centre, plate.along_b);
  const double beyond_a = a - std::clamp(a, -plate.half_a, plate.half_a);
  const double beyond_b = b - std::clamp(b, -plate.half_b, plate.half_b);
  const Vec3 normal = cross(plate.along_a, plate.along_b);
  return beyond_a * plate.along_a + beyond_b * plate.along_b + dot(centre, normal) * normal;
}

/// Of what stands in space by its pose.
Vec3 offset_from_placed(const Surface& surface, const Vec3& centre, double within) {
  const Pose& pose = surface.pose;
  const Vec3 own = turned(conjugate(pose.turn), centre - pose.origin);
  if (surface.sweep == Surface::Sweep::rectangle) {
    return turned(pose.turn, offset_from_plate(surface.plate, own));
  }
  const MeshPoint nearest = surface.mesh->nearest(surface.patch, own, within);
  if (!nearest.own) return {any_distance, 0.0, 0.0};
  return turned(pose.turn, nearest.offset);
}

/// Of a lying cylinder. On its axis every direction is as near: downwards stands for them.
Vec3 offset_from_lying(const Surface& surface, const Vec3& centre) {
  const double x = centre.x - surface.axis_x, z = centre.z - surface.axis_z;
  const double s = std::sqrt(x * x + z * z);
  if (s == 0.0) return {0.0, 0.0, surface.from_s};
  const double beyond = (s - surface.from_s) / s;
  return {beyond * x, 0.0, beyond * z};
}

}  // namespace

Vec3 offset_from(const Surface& surface, const Vec3& centre, double within) {
  if (surface.sweep == Surface::Sweep::lying) return offset_from_lying(surface, centre);
  if (surface.sweep > Surface::Sweep::lying) return offset_from_placed(surface, centre, within);
  const bool revolved = surface.sweep == Surface::Sweep::revolved;
  const double from_x = centre.x - surface.axis_x, from_y = centre.y - surface.axis_y;
  const double s = revolved ? std::sqrt(from_x * from_x + from_y * from_y) : centre.x;
  const double run_s = surface.to_s - surface.from_s;
  const double run_z = surface.to_z - surface.from_z;
  const double squared = run_s * run_s + run_z * run_z;
  const double rel_s = s - surface.from_s;
  const double rel_z = centre.z - surface.from_z;
  const double along = rel_s * run_s + rel_z * run_z;
  double off_s = 0.0, off_z = 0.0;
  if (along <= 0.0) {
    off_s = rel_s;
    off_z = rel_z;
  } else if (along >= squared) {
    off_s = s - surface.to_s;
    off_z = centre.z - surface.to_z;
  } else {
    // Along the profile's normal, so that the digits of a long wall are not lost.
    const double across = (rel_z * run_s - rel_s * run_z) / squared;
    off_s = -across * run_z;
    off_z = across * run_s;
  }
  if (!revolved) return {off_s, 0.0, off_z};
  // On the axis every direction is as near: the x axis stands for them.
  const double x = s > 0.0 ? from_x / s : 1.0;
  const double y = s > 0.0 ? from_y / s : 0.0;
  return {off_s * x, off_s * y, off_z};
}

bool is_within(const Surface& surface, const Vec3& centre, double distance) {
  if (surface.sweep == Surface::Sweep::mesh) {
    const Vec3 own = turned(conjugate(surface.pose.turn), centre - surface.pose.origin);
    return surface.mesh->is_within(surface.patch, own, distance);
  }
  const Vec3 offset = offset_from(surface, centre);
  return dot(offset, offset) < distance * distance;
}

namespace {

std::vector<Triangle> triangles_of(const Surface& surface) {
  std::vector<Triangle> result;
  if (surface.sweep == Surface::Sweep::rectangle) {
    const Vec3 a = surface.plate.half_a * surface.plate.along_a;
    const Vec3 b = surface.plate.half_b * surface.plate.along_b;
    const Vec3 none{};
    result = {{none - a - b, a - b, a + b}, {a + b, b - a, none - a - b}};
  } else {
    result = surface.mesh->triangles(surface.patch);
  }
  for (Triangle& triangle : result) {
    for (Vec3& corner : triangle) {
      corner = surface.pose.origin + turned(surface.pose.turn, corner);
    }
  }
  return result;
}

/// A lying cylinder as pictures show it.
void append_polygon(const Surface& s, std::vector<FrameWall>& walls) {
  constexpr int sides = 72;
  const auto corner = [&](int k) {
    const double angle = 2.0 * unit::pi * k / sides;
    return Vec3{s.axis_x + s.from_s * std::sin(angle), 0.0, s.axis_z - s.from_s * std::cos(angle)};
  };
  for (int k = 0; k < sides; ++k) {
    const Vec3 from = corner(k), to = corner(k + 1);
    walls.push_back({false, from.x, from.z, to.x, to.z, 0.0, 0.0, {}, true});
  }
}

}  // namespace

std::vector<FrameWall> outline(const std::vector<Surface>& surfaces) {
  std::vector<FrameWall> result;
  result.reserve(surfaces.size());
  for (const Surface& s : surfaces) {
    FrameWall wall;
    if (s.sweep == Surface::Sweep::lying) {
      append_polygon(s, result);
      continue;
    }
    if (s.sweep > Surface::Sweep::lying) {
      wall.triangles = triangles_of(s);
    } else {
      const bool revolved = s.sweep == Surface::Sweep::revolved;
      wall = {revolved, s.from_s, s.from_z, s.to_s, s.to_z, s.axis_x, s.axis_y, {}, false};
    }
    result.push_back(std::move(wall));
  }
  return result;
}

}  // namespace repose::engine
