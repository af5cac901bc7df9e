/// Mesh: a surface of triangles, cut into smooth patches.
///
/// Facets that meet at an edge with a small fold are one patch, and a patch acts as one surface: a
/// grain has one contact with it, at its nearest point, and one history. So a finely split plane is
/// a plane. Where patches meet at a sharp edge or corner, one of them owns it and the others keep
/// still there, and none acts from an edge while a neighbour's face is nearer.
///
/// What one contact a patch cannot show: a grain wider than a rounded groove touches both flanks of
/// it, which a patch that goes round the groove does not know. Then ask for a smaller smooth_angle.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "engine/mesh_tree.hpp"
#include "engine/stl.hpp"
#include "engine/unit.hpp"

namespace repose::engine {

struct MeshOptions {
  double scale = 1.0;                             ///< m to the file's unit: 0.001 for mm
  double smooth_angle = 20.0 * unit::pi / 180.0;  ///< largest fold inside a patch, rad
  double grain_diameter = 0.0;                    ///< m; a mesh smaller than that is refused
  bool closed = false;                            ///< refuses edges of one facet only
};

/// From the nearest point of a patch to a centre, m; `own` is false where there is none near enough
/// or where it belongs to another patch.
struct MeshPoint {
  Vec3 offset;
  bool own = false;
};

/// An edge or corner where patches meet: who owns it, and along which directions the facets about
/// it lead away from it.
struct MeshRim {
  struct Way {
    Vec3 direction;  ///< of unit length
    std::uint32_t patch = 0;
  };
  std::uint32_t owner = 0;
  std::vector<Way> ways;
};
inline constexpr std::uint32_t no_rim = 0xffffffff;
/// Rims of a facet's edges and corners, in the order of FacetPart.
using FacetRims = std::array<std::uint32_t, 6>;

struct MeshParts {
  std::vector<MeshTree> trees;  ///< one for each patch
  std::vector<FacetRims> facet_rims;
  std::vector<MeshRim> rims;
  Vec3 low, high;                      ///< corners of the box about it, m
  std::size_t boundary_edges = 0;      ///< of one facet only; a funnel has them, a solid has not
  std::size_t non_manifold_edges = 0;  ///< of more than two facets
};

class Mesh {
 public:
  explicit Mesh(MeshParts parts) : parts_(std::move(parts)) {}

  [[nodiscard]] const MeshParts& parts() const { return parts_; }
  [[nodiscard]] std::uint32_t patches() const {
    return static_cast<std::uint32_t>(parts_.trees.size());
  }
  [[nodiscard]] MeshPoint nearest(std::uint32_t patch, const Vec3& centre, double within) const;
  /// Whether a patch, edges of its neighbours included, comes nearer than a distance, m.
  [[nodiscard]] bool is_within(std::uint32_t patch, const Vec3& centre, double distance) const {
    return parts_.trees[patch].nearest(centre, distance).found;
  }
  [[nodiscard]] std::vector<Triangle> triangles(std::uint32_t patch) const;
  /// A box about a patch, m.
  [[nodiscard]] const Box& box(std::uint32_t patch) const { return parts_.trees[patch].box(); }

 private:
  MeshParts parts_;
};

/// From loose facets. Corners nearer to each other than a millionth of the diagonal of the whole
/// become one; facets given twice count once.
Result<Mesh, MeshError> make_mesh(std::span<const Triangle> facets, const MeshOptions& options);

/// From the bytes of an STL file, text or binary.
Result<Mesh, MeshError> mesh_from_stl(std::string_view bytes, const MeshOptions& options);

}  // namespace repose::engine
