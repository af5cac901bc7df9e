/// MeshWeld: loose facets as facets over shared points, and the edges at which they meet.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "engine/result.hpp"
#include "engine/stl.hpp"
#include "engine/triangle.hpp"

namespace repose::engine {

/// An edge of a facet: after that corner of it.
struct FacetEdge {
  std::uint32_t low = 0, high = 0;  ///< its points by number
  std::uint32_t facet = 0;
  std::uint32_t corner = 0;
};

struct WeldedFacets {
  std::vector<Vec3> points;                          ///< m
  std::vector<std::array<std::uint32_t, 3>> facets;  ///< their points
  std::vector<std::size_t> numbers;                  ///< of the facets in the file, from 1
  std::vector<FacetEdge> edges;                      ///< those that meet stand side by side

  [[nodiscard]] Triangle corners(std::uint32_t facet) const;
  /// Calls `see` with the edges that meet, once for each edge of the mesh.
  void for_each_edge(const std::function<void(std::span<const FacetEdge>)>& see) const;
};

/// Points nearer than `distance` (m) become one. Fails at a facet that is no higher than that.
Result<WeldedFacets, MeshError> weld(std::span<const Triangle> facets,
                                     double scale,
                                     double distance);

}  // namespace repose::engine
