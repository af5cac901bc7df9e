// From loose facets to a mesh: checks, patches, rims.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "engine/mesh.hpp"
#include "engine/mesh_weld.hpp"
#include "engine/unit.hpp"

namespace repose::engine {

namespace {

constexpr double weld_share = 1e-6;    // of the diagonal: some roundings of single precision
constexpr double largest_mesh = 10.0;  // m

/// Facets joined step by step; the smallest number of a group stands for it.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  std::uint32_t of(std::uint32_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t i = of(a), j = of(b);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

Box box_about(std::span<const Triangle> facets, double scale) {
  Box box = box_of(facets.front());
  for (const Triangle& facet : facets) box = hull(box, box_of(facet));
  return {scale * box.low, scale * box.high};
}

std::optional<MeshError> check_size(const Box& box, const MeshOptions& options) {
  const Vec3 size = box.high - box.low;
  const double across = std::max({size.x, size.y, size.z});
  if (across > largest_mesh) {
    return MeshError{MeshFault::wrong_unit,
                     0,
                     "the mesh is " + short_number(across) +
                         " m across: if its lengths are in mm, its "
                         "scale is 0.001, not " +
                         short_number(options.scale)};
  }
  if (across < options.grain_diameter) {
    return MeshError{
        MeshFault::wrong_unit,
        0,
        "the mesh is " + short_number(1e3 * across) + " mm across, less than a grain of " +
            short_number(1e3 * options.grain_diameter) +
            " mm: if its lengths are in m, its scale is 1, not " + short_number(options.scale)};
  }
  return std::nullopt;
}

std::optional<MeshError> check_edges(const WeldedFacets& welded,
                                     const MeshOptions& options,
                                     MeshParts& parts) {
  std::size_t first = 0;
  welded.for_each_edge([&](std::span<const FacetEdge> edge) {
    parts.non_manifold_edges += edge.size() > 2 ? 1 : 0;
    if (edge.size() > 1) return;
    ++parts.boundary_edges;
    const std::size_t facet = welded.numbers[edge.front().facet];
    first = first == 0 ? facet : std::min(first, facet);
  });
  if (!options.closed || parts.boundary_edges == 0) return std::nullopt;
  return MeshError{MeshFault::open,
                   first,
                   "facet " + std::to_string(first) + ": the mesh is open here; " +
                       std::to_string(parts.boundary_edges) + " edges belong to one facet only"};
}

/// Away from an edge into its facet, at right angles to the edge.
Vec3 inward(const WeldedFacets& welded, const FacetEdge& edge) {
  const auto& corners = welded.facets[edge.facet];
  const Vec3& from = welded.points[edge.low];
  const Vec3 along = welded.points[edge.high] - from;
  const Vec3 apex = welded.points[corners[(edge.corner + 2) % 3]] - from;
  const Vec3 across = apex - (dot(apex, along) / dot(along, along)) * along;
  return (1.0 / norm(across)) * across;
}

/// The patch of each facet, numbered by their first facets. Which way facets are oriented does not
/// matter.
std::vector<std::uint32_t> patches_of(const WeldedFacets& welded, double smooth_angle) {
  Groups groups(welded.facets.size());
  const double limit = std::cos(smooth_angle);
  welded.for_each_edge([&](std::span<const FacetEdge> edge) {
    if (edge.size() != 2) return;
    const double flat = -dot(inward(welded, edge[0]), inward(welded, edge[1]));  // cosine of fold
    if (flat >= limit) groups.join(edge[0].facet, edge[1].facet);
  });
  std::vector<std::uint32_t> patch(welded.facets.size());
  std::uint32_t count = 0;
  for (std::uint32_t f = 0; f < patch.size(); ++f) {
    patch[f] = groups.of(f) == f ? count++ : patch[groups.of(f)];
  }
  return patch;
}

std::vector<MeshTree> plant_trees(const WeldedFacets& welded,
                                  const std::vector<std::uint32_t>& patch) {
  std::vector<std::vector<MeshFacet>> facets(1 + *std::ranges::max_element(patch));
  for (std::uint32_t f = 0; f < patch.size(); ++f) {
    facets[patch[f]].push_back(mesh_facet(welded.corners(f), f));
  }
  std::vector<MeshTree> trees;
  trees.reserve(facets.size());
  for (auto& own : facets) trees.emplace_back(std::move(own));
  return trees;
}

/// An edge or corner of a facet.
struct Place {
  std::uint32_t facet;
  std::size_t part;  ///< as in FacetRims
};

void add_rim(MeshParts& parts, MeshRim rim, std::span<const Place> places) {
  const auto by_patch = [](const MeshRim::Way& a, const MeshRim::Way& b) {
    return a.patch < b.patch;
  };
  const auto [least, most] = std::ranges::minmax_element(rim.ways, by_patch);
  if (least->patch == most->patch) return;
  rim.owner = least->patch;
  const auto number = static_cast<std::uint32_t>(parts.rims.size());
  for (const Place& place : places) parts.facet_rims[place.facet][place.part] = number;
  parts.rims.push_back(std::move(rim));
}

void find_edge_rims(const WeldedFacets& welded,
                    const std::vector<std::uint32_t>& patch,
                    MeshParts& parts) {
  welded.for_each_edge([&](std::span<const FacetEdge> edge) {
    MeshRim rim;
    std::vector<Place> places;
    for (const FacetEdge& e : edge) {
      rim.ways.push_back({inward(welded, e), patch[e.facet]});
      places.push_back({e.facet, e.corner});
    }
    add_rim(parts, std::move(rim), places);
  });
}

void find_corner_rims(const WeldedFacets& welded,
                      const std::vector<std::uint32_t>& patch,
                      MeshParts& parts) {
  std::vector<std::vector<Place>> about(welded.points.size());
  for (std::uint32_t f = 0; f < patch.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) about[welded.facets[f][c]].push_back({f, 3 + c});
  }
  for (const std::vector<Place>& places : about) {
    if (places.empty()) continue;
    MeshRim rim;
    for (const Place& place : places) {
      const std::size_t corner = place.part - 3;
      const Triangle t = welded.corners(place.facet);
      for (const std::size_t other : {(corner + 1) % 3, (corner + 2) % 3}) {
        const Vec3 way = t[other] - t[corner];
        rim.ways.push_back({(1.0 / norm(way)) * way, patch[place.facet]});
      }
    }
    add_rim(parts, std::move(rim), places);
  }
}

}  // namespace

Result<Mesh, MeshError> make_mesh(std::span<const Triangle> facets, const MeshOptions& options) {
  if (facets.empty()) {
    return Unexpected{MeshError{MeshFault::not_stl, 0, "the mesh has no facet"}};
  }
  MeshParts parts;
  const Box box = box_about(facets, options.scale);
  if (auto error = check_size(box, options)) return Unexpected{*std::move(error)};
  parts.low = box.low;
  parts.high = box.high;
  const auto welded = weld(facets, options.scale, weld_share * norm(box.high - box.low));
  if (!welded) return Unexpected{welded.error()};
  if (auto error = check_edges(*welded, options, parts)) return Unexpected{*std::move(error)};
  const std::vector<std::uint32_t> patch = patches_of(*welded, options.smooth_angle);
  constexpr FacetRims none{no_rim, no_rim, no_rim, no_rim, no_rim, no_rim};
  parts.facet_rims.assign(welded->facets.size(), none);
  parts.trees = plant_trees(*welded, patch);
  find_edge_rims(*welded, patch, parts);
  find_corner_rims(*welded, patch, parts);
  return Mesh(std::move(parts));
}

}  // namespace repose::engine
