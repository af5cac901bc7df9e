#include "engine/mesh.hpp"

#include <algorithm>
#include <cmath>

namespace repose::engine {

namespace {

/// A centre that leads towards a neighbour's face is nearer to that face. The tolerance is wider
/// than rounding, so that a patch never leaves an edge to one that has left it, too.
bool acts_from(const MeshRim& rim, std::uint32_t patch, const Vec3& offset) {
  constexpr double tolerance = 1e-9;
  const double least = tolerance * norm(offset);
  const bool hidden = std::ranges::any_of(rim.ways, [&](const MeshRim::Way& way) {
    return way.patch != patch && dot(offset, way.direction) > least;
  });
  return !hidden && rim.owner == patch;
}

}  // namespace

MeshPoint Mesh::nearest(std::uint32_t patch, const Vec3& centre, double within) const {
  const MeshTree::Nearest nearest = parts_.trees[patch].nearest(centre, within);
  if (!nearest.found) return {};
  if (nearest.part == FacetPart::inside) return {nearest.offset, true};
  const auto part = static_cast<std::size_t>(nearest.part) - 1;
  const std::uint32_t rim = parts_.facet_rims[nearest.facet][part];
  return {nearest.offset, rim == no_rim || acts_from(parts_.rims[rim], patch, nearest.offset)};
}

std::vector<Triangle> Mesh::triangles(std::uint32_t patch) const {
  std::vector<Triangle> result;
  const std::span<const MeshFacet> facets = parts_.trees[patch].facets();
  result.reserve(facets.size());
  for (const MeshFacet& f : facets) {
    result.push_back({f.first, f.first + f.to_second, f.first + f.to_third});
  }
  return result;
}

Result<Mesh, MeshError> mesh_from_stl(std::string_view bytes, const MeshOptions& options) {
  const auto facets = read_stl(bytes);
  if (!facets) return Unexpected{facets.error()};
  return make_mesh(*facets, options);
}

}  // namespace repose::engine
