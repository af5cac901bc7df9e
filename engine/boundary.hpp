/// Boundary: walls without thickness. Both faces and the free edges act, so a kettle has a rim and
/// a hopper an orifice.
///
/// A wall is a straight profile swept round an upright axis or along y, a cylinder that lies along
/// y, a flat rectangle anywhere in space, or a smooth patch of a mesh. It may move as a rigid body;
/// see wall_motion.hpp.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "engine/frame.hpp"
#include "engine/material.hpp"
#include "engine/mesh.hpp"
#include "engine/quaternion.hpp"
#include "engine/vec3.hpp"

namespace repose::engine {

/// Where the own frame of a rectangle or a mesh is, and how it is turned.
struct Pose {
  Vec3 origin;  ///< m
  Quaternion turn;
};

/// A flat rectangle about the origin of its own frame.
struct Plate {
  Vec3 along_a{1.0, 0.0, 0.0};        ///< unit vector along its first side
  Vec3 along_b{0.0, 1.0, 0.0};        ///< and along its second
  double half_a = 0.0, half_b = 0.0;  ///< half its sides, m
};

/// A wall. What is swept runs in its half plane (s, z) from (from_s, from_z) to (to_s, to_z); s is
/// the distance from the axis (revolved) or x (extruded along y); of a lying cylinder from_s is the
/// radius. Lengths in m. Rectangles and
/// meshes stand once, also where the scene repeats.
struct Surface {
  enum class Sweep { extruded, revolved, lying, rectangle, mesh };
  Sweep sweep = Sweep::extruded;
  double from_s = 0.0, from_z = 0.0;
  double to_s = 0.0, to_z = 0.0;
  MaterialId material = MaterialId::wall;  ///< grain: covered with grains' stuff
  Vec3 velocity;                           ///< of its points, m/s; at the pivot where it spins
  Vec3 spin;                               ///< rad/s
  Vec3 pivot;                              ///< a point of the axis of spin, m; goes with the wall
  bool belt = false;  ///< its points move as stated while the wall stays in its place
  double axis_x = 0.0, axis_y = 0.0;  ///< of what is revolved
  double axis_z = 0.0;                ///< with axis_x: of a lying cylinder
  Pose pose{};                        ///< of a rectangle or mesh
  Plate plate{};                      ///< of a rectangle
  std::shared_ptr<const Mesh> mesh{};
  std::uint32_t patch = 0;  ///< of the mesh
};

/// z = const over all x and y.
Surface plane(double z, MaterialId material = MaterialId::wall);
/// z = const between two values of x, endless along y.
Surface strip(double low_x, double high_x, double z, MaterialId material = MaterialId::wall);
/// x = const, from z = low to high, endless along y.
Surface upright(double x, double low, double high, MaterialId material = MaterialId::wall);
/// The mantle of a cylinder round the z axis.
Surface cylinder(double radius, double low, double high, MaterialId material = MaterialId::wall);
/// The mantle of a truncated cone round the z axis.
Surface cone(double low_radius,
             double low,
             double high_radius,
             double high,
             MaterialId material = MaterialId::wall);
/// A flat disc, with a hole where inner > 0.
Surface disc(double radius, double z, MaterialId material = MaterialId::wall, double inner = 0.0);
/// A flat rectangle, from its centre to the middles of two neighbouring sides: half its sides, at
/// right angles.
Surface rectangle(const Vec3& centre,
                  const Vec3& half_a,
                  const Vec3& half_b,
                  MaterialId material = MaterialId::wall);
/// The mantle of a cylinder about an axis along y, endless: a drum. Its pivot is on the axis.
Surface lying_cylinder(double radius, double x, double z, MaterialId material = MaterialId::wall);
/// Flat ribs on the inner side of a lying cylinder, evenly spaced, the first one lowest: lifters.
/// Their pivots are on the axis.
std::vector<Surface> lying_ribs(int count,
                                double radius,
                                double height,
                                double x,
                                double z,
                                MaterialId material = MaterialId::wall);
/// Flat ribs that stand upright on the inner side of a mantle round the z axis, evenly spaced from
/// the x axis on: lifters of a drum.
std::vector<Surface> ribs(int count,
                          double radius,
                          double height,
                          double low,
                          double high,
                          MaterialId material = MaterialId::wall);
/// The patches of a mesh, a surface each.
std::vector<Surface> mesh_surfaces(const std::shared_ptr<const Mesh>& mesh,
                                   MaterialId material = MaterialId::wall,
                                   const Pose& pose = {});

inline constexpr double any_distance = std::numeric_limits<double>::infinity();

/// From the nearest point of a surface to a centre. Endless for a mesh where that point is farther
/// than `within`, or is an edge that belongs to a neighbouring patch.
Vec3 offset_from(const Surface& surface, const Vec3& centre, double within = any_distance);

/// Whether a surface comes nearer to a centre than a distance, m.
bool is_within(const Surface& surface, const Vec3& centre, double distance);

/// The surfaces as a picture needs them.
std::vector<FrameWall> outline(const std::vector<Surface>& surfaces);

}  // namespace repose::engine
