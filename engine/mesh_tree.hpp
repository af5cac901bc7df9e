/// MeshTree: the facets of one patch in nested boxes, so that the nearest point is found without
/// looking at them all.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/triangle.hpp"

namespace repose::engine {

/// A facet as the search sees it.
struct MeshFacet {
  Vec3 first;           ///< corner, m
  Vec3 to_second;       ///< from it to the second corner, m
  Vec3 to_third;        ///< and to the third
  Vec3 normal;          ///< of unit length
  std::uint32_t facet;  ///< number in the mesh
};

MeshFacet mesh_facet(const Triangle& triangle, std::uint32_t facet);

/// Where on a facet a point lies: inside, on the edge after corner 0, 1 or 2, or on that corner.
enum class FacetPart : std::uint8_t {
  inside,
  edge_0,
  edge_1,
  edge_2,
  corner_0,
  corner_1,
  corner_2
};

/// From the nearest point of a facet to a centre.
struct FacetOffset {
  Vec3 offset;  ///< m
  FacetPart part;
};
FacetOffset offset_from(const MeshFacet& facet, const Vec3& centre);

class MeshTree {
 public:
  /// Of at least one facet.
  explicit MeshTree(std::vector<MeshFacet> facets);

  struct Nearest {
    bool found = false;
    Vec3 offset;  ///< from the nearest point to the centre, m
    FacetPart part = FacetPart::inside;
    std::uint32_t facet = 0;  ///< number in the mesh
  };
  /// The nearest point that is nearer than `within`, m.
  [[nodiscard]] Nearest nearest(const Vec3& centre, double within) const;

  [[nodiscard]] std::span<const MeshFacet> facets() const { return facets_; }
  [[nodiscard]] const Box& box() const { return nodes_.front().box; }

 private:
  /// A box and its facets, or its two halves: the one that follows it, and `other`.
  struct Node {
    Box box;
    std::uint32_t first = 0, count = 0;  ///< facets; none where there are halves
    std::uint32_t other = 0;
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t count);
  [[nodiscard]] Box box_of(std::uint32_t first, std::uint32_t count) const;
  static double squared_distance(const Box& box, const Vec3& centre);

  std::vector<MeshFacet> facets_;
  std::vector<Node> nodes_;
};

}  // namespace repose::engine
