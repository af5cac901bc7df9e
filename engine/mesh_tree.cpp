#include "engine/mesh_tree.hpp"

#include <algorithm>
#include <cmath>

namespace repose::engine {

namespace {

constexpr std::uint32_t leaf_facets = 4;

double Vec3::*longest_axis(const Vec3& size) {
  if (size.x >= size.y && size.x >= size.z) return &Vec3::x;
  return size.y >= size.z ? &Vec3::y : &Vec3::z;
}

Vec3 centroid(const MeshFacet& f) { return f.first + (1.0 / 3.0) * (f.to_second + f.to_third); }

}  // namespace

MeshFacet mesh_facet(const Triangle& triangle, std::uint32_t facet) {
  const Vec3 a = triangle[1] - triangle[0], b = triangle[2] - triangle[0];
  const Vec3 across = cross(a, b);
  return {triangle[0], a, b, (1.0 / norm(across)) * across, facet};
}

/// By the regions about a triangle that its edges and corners are nearest in (Ericson 2005,
/// Real-Time Collision Detection, section 5.1.5).
FacetOffset offset_from(const MeshFacet& f, const Vec3& centre) {
  const Vec3& ab = f.to_second;
  const Vec3& ac = f.to_third;
  const Vec3 ap = centre - f.first;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {ap, FacetPart::corner_0};
  const Vec3 bp = ap - ab;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return {bp, FacetPart::corner_1};
  const Vec3 cp = ap - ac;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return {cp, FacetPart::corner_2};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {ap - (d1 / (d1 - d3)) * ab, FacetPart::edge_0};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {ap - (d2 / (d2 - d6)) * ac, FacetPart::edge_2};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    const double share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {bp - share * (ac - ab), FacetPart::edge_1};
  }
  return {dot(ap, f.normal) * f.normal, FacetPart::inside};
}

MeshTree::MeshTree(std::vector<MeshFacet> facets) : facets_(std::move(facets)) {
  nodes_.reserve(2 * facets_.size());
  build(0, static_cast<std::uint32_t>(facets_.size()));
}

Box MeshTree::box_of(std::uint32_t first, std::uint32_t count) const {
  Box box{facets_[first].first, facets_[first].first};
  for (std::uint32_t k = first; k < first + count; ++k) {
    const MeshFacet& f = facets_[k];
    box = hull(box, engine::box_of({f.first, f.first + f.to_second, f.first + f.to_third}));
  }
  return box;
}

/// Halves at the median along the longest axis.
std::uint32_t MeshTree::build(std::uint32_t first, std::uint32_t count) {
  const auto self = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({box_of(first, count), first, count, 0});
  if (count <= leaf_facets) return self;
  const Box& box = nodes_[self].box;
  const auto axis = longest_axis(box.high - box.low);
  const std::uint32_t half = count / 2;
  const auto begin = facets_.begin() + first;
  // A whole sort, so that the order is the same with every standard library.
  std::sort(begin, begin + count, [axis](const MeshFacet& a, const MeshFacet& b) {
    const double x = centroid(a).*axis, y = centroid(b).*axis;
    return x < y || (x == y && a.facet < b.facet);
  });
  build(first, half);
  const std::uint32_t other = build(first + half, count - half);
  nodes_[self].count = 0;
  nodes_[self].other = other;
  return self;
}

double MeshTree::squared_distance(const Box& box, const Vec3& p) {
  const auto beyond = [](double x, double low, double high) {
    return x < low ? low - x : x > high ? x - high : 0.0;
  };
  const Vec3 d{beyond(p.x, box.low.x, box.high.x),
               beyond(p.y, box.low.y, box.high.y),
               beyond(p.z, box.low.z, box.high.z)};
  return dot(d, d);
}

MeshTree::Nearest MeshTree::nearest(const Vec3& centre, double within) const {
  Nearest best;
  double least = within * within;
  if (squared_distance(nodes_[0].box, centre) >= least) return best;
  struct Waiting {
    std::uint32_t node;
    double squared;
  };
  std::array<Waiting, 64> stack;  // halves: deeper than any count of facets
  std::size_t waiting = 0;
  stack[waiting++] = {0, 0.0};
  while (waiting > 0) {
    const Waiting next = stack[--waiting];
    if (next.squared >= least) continue;
    const Node& node = nodes_[next.node];
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      const FacetOffset found = offset_from(facets_[k], centre);
      const double squared = dot(found.offset, found.offset);
      if (squared >= least) continue;
      least = squared;
      best = {true, found.offset, found.part, facets_[k].facet};
    }
    if (node.count > 0) continue;
    Waiting near{next.node + 1, squared_distance(nodes_[next.node + 1].box, centre)};
    Waiting far{node.other, squared_distance(nodes_[node.other].box, centre)};
    if (far.squared < near.squared) std::swap(near, far);
    if (far.squared < least) stack[waiting++] = far;
    if (near.squared < least) stack[waiting++] = near;
  }
  return best;
}

}  // namespace repose::engine
